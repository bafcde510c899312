#include <lgabench/study/server.hpp>

#include <fmt/format.h>
#include <httplib.h>
#include <pthread.h>
#include <sys/mman.h>

#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <vector>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/study/connection_limits.hpp>
#include <lgabench/study/withdrawal.hpp>

namespace lgabench::study {
namespace {

using httplib::Request;
using httplib::Response;

constexpr std::size_t largest_body = 256 << 10, largest_request = 2 * largest_body, most_events = 50, threads = 128;
constexpr std::size_t stack = 16 << 20, kept_stack = 64 << 10;
constexpr double longest_request_s = 10;
constexpr const char* json_type = "application/json";

// Nothing from elsewhere, nothing kept, no address of a session told to anybody.
const httplib::Headers guards{
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; base-uri 'none'; "
     "form-action 'none'; frame-ancestors 'none'"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"},
    {"X-Content-Type-Options", "nosniff"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

// httplib reads a Range by a regular expression that goes deeper with each character of a header: more than the
// system's stack may hold, and what one request took each thread would keep.
httplib::ThreadPool* pool_with_own_stacks() {
  pthread_attr_t attributes;
  ::pthread_getattr_default_np(&attributes);
  ::pthread_attr_setstacksize(&attributes, stack);
  ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
  return new httplib::ThreadPool(threads);
}

void give_stack_back() {
  pthread_attr_t attributes;
  void* lowest = nullptr;
  std::size_t size = 0;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0) return;
  ::pthread_attr_getstack(&attributes, &lowest, &size);
  ::pthread_attr_destroy(&attributes);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const auto used = static_cast<std::size_t>(reinterpret_cast<char*>(&attributes) - static_cast<char*>(lowest));
  if (used > kept_stack) ::madvise(lowest, (used - kept_stack) / page * page, MADV_DONTNEED);
}

// Answers are whole and as they are: httplib would build one of thousands of ranges in memory, and compress each anew.
void answer_whole(const Request& request) {
  auto& own = const_cast<Request&>(request);  // httplib's, which it reads after this
  own.ranges.clear();
  own.headers.erase("Accept-Encoding");
  give_stack_back();
}

void reply(Response& response, int status, const Json& json) {
  response.status = status;
  response.set_content(canonical(json), json_type);
}

// Runs what answers a request; what it throws becomes a status. What the disk says is the researcher's, not the page's.
void guarded(Response& response, const std::function<std::optional<Json>()>& answer) {
  try {
    if (const std::optional<Json> json = answer())
      reply(response, 200, *json);
    else
      reply(response, 404, {{"error", "not here"}});
  } catch (const Refused& e) {
    reply(response, e.why() == Refused::conflict ? 409 : e.why() == Refused::later ? 429 : 400, {{"error", e.what()}});
  } catch (const std::exception& e) {
    to_stderr("study: {}\n", one_line(e.what()));
    reply(response, 507, {{"error", "it cannot be saved now"}});
  }
}

Json body_of(const Request& request) {
  try {
    return parse_json(request.body, "body");
  } catch (const InputError& e) {
    throw Refused(Refused::bad, e.what());
  }
}

std::string text_of(const Json& body, const char* member) {
  if (!body.is_object() || !body.contains(member) || !body.at(member).is_string())
    throw Refused(Refused::bad, fmt::format("body: expected \"{}\"", member));
  return body.at(member).get<std::string>();
}

}  // namespace

struct Server::Impl {
  Study& study;
  Site site;
  Listening where;
  std::vector<std::string> hosts;  // what a Host header may say
  httplib::Server http;
  int port = 0;
  std::mutex beginning;
  std::deque<std::chrono::steady_clock::time_point> begun;  // of the last minute

  Impl(Study& of, Site made_of, Listening at) : study(of), site(std::move(made_of)), where(std::move(at)) {
    http.new_task_queue = pool_with_own_stacks;
    http.set_payload_max_length(largest_body);
    http.set_read_timeout(10);
    http.set_keep_alive_max_count(1);  // so that a connection's deadline is a request's
    http.set_tcp_nodelay(true);
    http.set_default_headers(guards);
    http.set_pre_routing_handler(
        [this](const Request& request, Response& response) { return admit(request, response); });
    http.set_error_handler([](const Request& request, Response& response) {
      answer_whole(request);  // one that is malformed comes here first
      if (response.body.empty()) response.set_content(fmt::format("{}\n", response.status), "text/plain");
    });
    pages();
    sessions();
    if (where.port == 0)
      port = http.bind_to_any_port(where.address);
    else
      port = http.bind_to_port(where.address, where.port) ? where.port : -1;
    if (port <= 0)
      throw InputError(
          fmt::format("{}:{}: cannot listen there: does another program use that port?", where.address, where.port));
    for (const char* own : {"127.0.0.1", "localhost", "[::1]"}) {
      hosts.push_back(fmt::format("{}:{}", own, port));
      if (port == 80) hosts.emplace_back(own);  // a browser leaves HTTP's own port out
    }
    if (!where.host.empty()) hosts.push_back(where.host);
  }

  // Another Host is a name that somebody else points here; another Origin is somebody else's page.
  httplib::Server::HandlerResponse admit(const Request& request, Response& response) const {
    answer_whole(request);
    const auto refuse = [&response](int status, const char* why) {
      reply(response, status, {{"error", why}});
      return httplib::Server::HandlerResponse::Handled;
    };
    const std::string host = request.get_header_value("Host");
    if (std::find(hosts.begin(), hosts.end(), host) == hosts.end()) return refuse(421, "another Host is served here");
    if (request.method == "GET" || request.method == "HEAD") return httplib::Server::HandlerResponse::Unhandled;
    if (request.method != "POST") return refuse(405, "GET or POST");
    if (const std::string origin = request.get_header_value("Origin");
        !origin.empty() && origin != "http://" + host && origin != "https://" + host)
      return refuse(403, "another Origin");
    if (request.get_header_value("Content-Type") != json_type) return refuse(415, "expected JSON");
    // httplib bounds a body by its Content-Length alone, before it is decompressed.
    if (request.has_header("Content-Encoding")) return refuse(415, "expected a body that is not compressed");
    if (request.has_header("Transfer-Encoding") || !request.has_header("Content-Length"))
      return refuse(411, "expected a Content-Length");
    return httplib::Server::HandlerResponse::Unhandled;
  }

  void pages() {
    const auto serve = [this](const char* path, const std::string& text, const char* type) {
      http.Get(path, [&text, type](const Request&, Response& response) { response.set_content(text, type); });
    };
    for (const char* path : {"/", "/withdraw", "/p/[0-9a-f]{32}"}) serve(path, site.page, "text/html; charset=utf-8");
    serve("/study.css", site.style, "text/css; charset=utf-8");
    serve("/study.js", site.script, "text/javascript; charset=utf-8");
    serve("/object_types.png", site.object_types.png, "image/png");
    serve("/textures.png", site.textures.png, "image/png");
    http.Get("/favicon.ico", [](const Request&, Response& response) { response.status = 204; });
    http.Get("/study.json", [this](const Request&, Response& response) {
      const Protocol& p = study.protocol();
      reply(response, 200,
            {{"title", p.title},
             {"contact", p.contact},
             {"consent", p.consent},
             {"instruction", p.instruction},
             {"consent_sha256", sha256(p.consent)},
             {"rehearsal", study.kind() == Kind::rehearsal},
             {"pictures", {{"object_types", site.object_types.cells}, {"textures", site.textures.cells}}}});
    });
  }

  // Each who begins takes a place of a balanced plan: whoever is not invited, or no person, must not.
  std::string begin(const Json& body) {
    const std::string key = text_of(body, "key"), consent = text_of(body, "consent");
    if (!is_id(key)) throw Refused(Refused::bad, "body: expected a key of 32 hexadecimal digits");
    if (!where.invitation.empty() && body.value("invitation", Json()) != where.invitation)
      throw Refused(Refused::bad, "this study is by invitation: open the link that you were sent");
    const std::lock_guard lock(beginning);
    const auto now = std::chrono::steady_clock::now();
    while (!begun.empty() && now - begun.front() > std::chrono::minutes(1)) begun.pop_front();
    const bool is_new = !study.knows(key);
    if (is_new && where.begins_a_minute > 0 && begun.size() >= static_cast<std::size_t>(where.begins_a_minute))
      throw Refused(Refused::later, "many people begin at this moment: try again in a minute");
    std::string id = study.begin(key, consent, body.value("simulated", Json()) == true);
    if (is_new) begun.push_back(now);
    return id;
  }

  void sessions() {
    http.Post("/begin", [this](const Request& request, Response& response) {
      guarded(response, [&]() -> std::optional<Json> { return Json{{"id", begin(body_of(request))}}; });
    });
    http.Post("/withdraw", [this](const Request& request, Response& response) {
      guarded(response, [&]() -> std::optional<Json> {
        if (!study.withdraw(text_of(body_of(request), "code"))) return std::nullopt;
        return Json::object();
      });
    });
    http.Post("/p/([0-9a-f]{32})/events", [this](const Request& request, Response& response) {
      guarded(response, [&]() -> std::optional<Json> {
        const Json body = body_of(request);
        if (!body.is_object() || !body.contains("events") || !body.at("events").is_array() ||
            body.at("events").empty() || body.at("events").size() > most_events)
          throw Refused(Refused::bad, fmt::format("body: expected 1 to {} events", most_events));
        std::optional<Json> state;
        for (const Json& event : body.at("events")) {
          const std::optional<Json> now = study.post(request.matches[1], event);
          if (!now) return std::nullopt;
          if (!state || !now->empty()) state = now;
        }
        return state;
      });
    });
  }
};

Server::Server(Study& study, Site site, Listening where)
    : impl_(std::make_unique<Impl>(study, std::move(site), std::move(where))) {}
Server::~Server() = default;
int Server::port() const { return impl_->port; }
void Server::run() {
  // A thread: with the caller's mask of signals.
  const ConnectionLimits limits(impl_->port, longest_request_s, largest_request);
  impl_->http.listen_after_bind();
}
void Server::stop() { impl_->http.stop(); }

}  // namespace lgabench::study
