#include <lgabench/study/server.hpp>

#include <fmt/format.h>

#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <vector>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/http/guarded.hpp>
#include <lgabench/study/withdrawal.hpp>

namespace lgabench::study {
namespace {

using http::reply;
using httplib::Request;
using httplib::Response;

constexpr std::size_t most_events = 50;

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
  http::GuardedServer server;
  std::mutex beginning;
  std::deque<std::chrono::steady_clock::time_point> begun;  // of the last minute

  Impl(Study& of, Site made_of, Listening at)
      : study(of),
        site(std::move(made_of)),
        where(std::move(at)),
        server({where.address, where.port, where.host}, guards, http::Takes::json) {
    pages();
    sessions();
  }

  void pages() {
    const auto serve = [this](const char* path, const std::string& text, const char* type) {
      server.pages.Get(path, [&text, type](const Request&, Response& response) { response.set_content(text, type); });
    };
    for (const char* path : {"/", "/withdraw", "/p/[0-9a-f]{32}"}) serve(path, site.page, "text/html; charset=utf-8");
    serve("/study.css", site.style, "text/css; charset=utf-8");
    serve("/study.js", site.script, "text/javascript; charset=utf-8");
    serve("/object_types.png", site.object_types.png, "image/png");
    serve("/textures.png", site.textures.png, "image/png");
    serve("/pairs.png", site.pairs.png, "image/png");
    server.pages.Get("/favicon.ico", [](const Request&, Response& response) { response.status = 204; });
    server.pages.Get("/study.json", [this](const Request&, Response& response) {
      const Protocol& p = study.protocol();
      reply(response, 200,
            {{"title", p.title},
             {"contact", p.contact},
             {"consent", p.consent},
             {"instruction", p.instruction},
             {"consent_sha256", sha256(p.consent)},
             {"rehearsal", study.kind() == Kind::rehearsal},
             {"pictures",
              {{"object_types", site.object_types.cells},
               {"textures", site.textures.cells},
               {"pairs", site.pairs.cells}}}});
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
    server.pages.Post("/begin", [this](const Request& request, Response& response) {
      guarded(response, [&]() -> std::optional<Json> { return Json{{"id", begin(body_of(request))}}; });
    });
    server.pages.Post("/withdraw", [this](const Request& request, Response& response) {
      guarded(response, [&]() -> std::optional<Json> {
        if (!study.withdraw(text_of(body_of(request), "code"))) return std::nullopt;
        return Json::object();
      });
    });
    server.pages.Post("/p/([0-9a-f]{32})/events", [this](const Request& request, Response& response) {
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
int Server::port() const { return impl_->server.port(); }
void Server::run() { impl_->server.run(); }
void Server::stop() { impl_->server.stop(); }

}  // namespace lgabench::study
