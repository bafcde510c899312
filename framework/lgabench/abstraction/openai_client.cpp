#include <lgabench/abstraction/openai_client.hpp>

#include <curl/curl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <ctime>
#include <mutex>
#include <regex>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <lgabench/abstraction/completion.hpp>
#include <lgabench/abstraction/server_response.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

struct Response : ServerResponse {
  bool late = false;    // the request was sent, and no whole reply came in time
  bool absent = false;  // nobody listens there, or no such host is known
};

// Fewer bytes than were given end the transfer.
std::size_t collect(char* bytes, std::size_t size, std::size_t count, void* into) {
  std::string& body = *static_cast<std::string*>(into);
  if (body.size() + size * count > OpenAiClient::most_bytes) return 0;
  body.append(bytes, size * count);
  return size * count;
}

// Of curl's own words, where a request leaves by a proxy that a variable names.
int note_proxy(CURL*, curl_infotype kind, char* bytes, std::size_t size, void* into) {
  const std::string_view line(bytes, size), uses = "Uses proxy env variable ";
  const std::size_t named = line.find("== '");
  if (kind == CURLINFO_TEXT && line.substr(0, uses.size()) == uses && named != line.npos)
    *static_cast<std::string*>(into) = line.substr(named + 4, line.rfind('\'') - named - 4);
  return 0;
}

bool is_loopback(const std::string& url) {
  const std::string host = provider({url, ""});
  const std::size_t begin = host.find("://") == std::string::npos ? 0 : host.find("://") + 3;
  const auto is = [&](std::string_view name) { return host.compare(begin, name.size(), name) == 0; };
  return is("127.") || is("[::1]") || is("localhost:") || is("localhost/");
}

// Curl's words without the time that they tell, which differs between threads that wait for the same thing.
std::string untimed(const std::string& problem) {
  static const std::regex time(" after [0-9]+ (ms|milliseconds)");
  return std::regex_replace(problem, time, "");
}

struct Headers {
  curl_slist* list = nullptr;
  Headers() = default;
  Headers(const Headers&) = delete;
  Headers& operator=(const Headers&) = delete;
  ~Headers() { curl_slist_free_all(list); }
  void add(const std::string& header) { list = curl_slist_append(list, header.c_str()); }
};

Response post(CURL* handle, const OpenAiOptions& options, const std::string& body) {
  Headers headers;
  Response response;
  char problem[CURL_ERROR_SIZE] = "";
  headers.add("Content-Type: application/json");
  if (!options.api_key.empty()) headers.add("Authorization: Bearer " + options.api_key);
  curl_easy_reset(handle);  // which keeps its connections
  const auto set = [handle](CURLoption option, auto value) { curl_easy_setopt(handle, option, value); };
  const std::string url = options.base_url + "/chat/completions";
  set(CURLOPT_URL, url.c_str());
  set(CURLOPT_PROTOCOLS_STR, "http,https");
  set(CURLOPT_HTTPHEADER, headers.list);
  set(CURLOPT_POSTFIELDS, body.c_str());
  set(CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
  set(CURLOPT_WRITEFUNCTION, collect);
  set(CURLOPT_WRITEDATA, &response.body);
  set(CURLOPT_ERRORBUFFER, problem);
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_TIMEOUT, options.timeout_s);
  set(CURLOPT_CONNECTTIMEOUT, std::min(options.timeout_s, 60L));
  std::string proxy;
  if (is_loopback(url)) set(CURLOPT_PROXY, "");  // whatever http_proxy says
  set(CURLOPT_VERBOSE, 1L);
  set(CURLOPT_DEBUGFUNCTION, note_proxy);
  set(CURLOPT_DEBUGDATA, &proxy);
  if (!options.ca_file.empty()) set(CURLOPT_CAINFO, options.ca_file.c_str());
  set(CURLOPT_TCP_KEEPALIVE, 1L);  // nothing else goes over the line while the server computes
  const CURLcode code = curl_easy_perform(handle);
  if (code != CURLE_OK) {
    const bool untrusted = code == CURLE_PEER_FAILED_VERIFICATION, too_long = code == CURLE_WRITE_ERROR;
    const bool no_address = code == CURLE_UNSUPPORTED_PROTOCOL || code == CURLE_URL_MALFORMAT;
    long tunnel = 0;  // what a proxy said to CONNECT
    curl_easy_getinfo(handle, CURLINFO_HTTP_CONNECTCODE, &tunnel);
    const bool shut_out = tunnel >= 400 && tunnel < 500 && tunnel != 408 && tunnel != 429;
    response.final = untrusted || too_long || no_address || shut_out || code == CURLE_SSL_CACERT_BADFILE;
    long sent = 0;
    curl_easy_getinfo(handle, CURLINFO_REQUEST_SIZE, &sent);
    response.late = code == CURLE_OPERATION_TIMEDOUT && sent > 0;
    const bool tls = untrusted || code == CURLE_SSL_CONNECT_ERROR || code == CURLE_SSL_CACERT_BADFILE;
    long error = 0;
    curl_easy_getinfo(handle, CURLINFO_OS_ERRNO, &error);
    response.absent = (code == CURLE_COULDNT_CONNECT && error == ECONNREFUSED) || code == CURLE_COULDNT_RESOLVE_HOST ||
                      code == CURLE_COULDNT_RESOLVE_PROXY || code == CURLE_SSL_CONNECT_ERROR;
    response.problem = too_long ? fmt::format("a reply of more than {} bytes", OpenAiClient::most_bytes)
                                : (tls ? "TLS: " : "") + untimed(*problem ? problem : curl_easy_strerror(code));
    if (!proxy.empty()) response.problem += fmt::format(", through the proxy {}", provider({proxy, ""}));
    return response;
  }
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &response.status);
  curl_off_t seconds = 0;
  if (curl_easy_getinfo(handle, CURLINFO_RETRY_AFTER, &seconds) == CURLE_OK)
    response.retry_after_s = static_cast<double>(seconds);
  const char* moved_to = nullptr;
  if (curl_easy_getinfo(handle, CURLINFO_REDIRECT_URL, &moved_to) == CURLE_OK && moved_to) response.moved_to = moved_to;
  response.body = mended_json(response.body);
  return response;
}

}  // namespace

// Handles that nobody uses now, each with the connection of its last request.
struct OpenAiClient::Connections {
  Connections() = default;
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;
  ~Connections() {
    for (CURL* handle : idle) curl_easy_cleanup(handle);
  }
  CURL* take() {
    const std::lock_guard lock(mutex);
    if (idle.empty()) return curl_easy_init();
    CURL* const handle = idle.back();
    idle.pop_back();
    return handle;
  }
  void give_back(CURL* handle) {
    const std::lock_guard lock(mutex);
    idle.push_back(handle);
  }

  // What several threads wait for is said once, until a reply comes.
  bool is_new(const std::string& why) {
    const std::lock_guard lock(mutex);
    return std::exchange(said, why) != why;
  }

  std::mutex mutex;
  std::vector<CURL*> idle;
  std::string said;
  std::atomic<bool> was_there{false};  // the server
};

OpenAiClient::OpenAiClient(OpenAiOptions options)
    : options_(std::move(options)), connections_(std::make_unique<Connections>()) {
  static const CURLcode once = curl_global_init(CURL_GLOBAL_DEFAULT);
  if (once != CURLE_OK) throw Error("libcurl could not be initialised");
}

OpenAiClient::~OpenAiClient() = default;

ChatReply OpenAiClient::complete(const Json& request) {
  if (options_.base_url == openai_server && options_.api_key.empty())
    throw MethodError(
        "OPENAI_API_KEY is not set, and neither is OPENAI_BASE_URL, the address of another server; see "
        "docs/language-models.md");
  using Clock = std::chrono::steady_clock;
  constexpr double longest_wait_s = 60;
  const Clock::time_point start = Clock::now();
  const std::string body = canonical(request);
  double wait_s = options_.first_wait_s;
  for (int attempt = 1;; ++attempt) {
    CURL* const handle = connections_->take();
    const Response response = post(handle, options_, body);
    connections_->give_back(handle);
    if (response.status != 0) connections_->was_there = true;
    const auto [next, why] = verdict_of(response, options_.api_key);
    if (next == Verdict::Next::read) {
      try {
        ChatReply reply = read_completion(response.body);
        for (std::string* said : {&reply.text, &reply.served}) *said = without_key(std::move(*said), options_.api_key);
        reply.seconds = std::chrono::duration<double>(Clock::now() - start).count();
        reply.day = fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)));
        connections_->is_new("");
        return reply;
      } catch (const Error& e) {  // not what a completion looks like, or none that could be an answer
        throw NoAnswer(without_key(e.what(), options_.api_key));
      }
    }
    if (response.late) throw NoAnswer(fmt::format("no reply within {} s (--reply-timeout)", options_.timeout_s));
    if (next == Verdict::Next::skip) throw NoAnswer(why);
    if (next == Verdict::Next::stop) throw MethodError(why);
    if (response.absent && !options_.was_there && !connections_->was_there)
      throw MethodError(fmt::format("no server at {}: {}", provider(options_), why));
    // An error in the place of a completion concerns its question: another may find the model loaded.
    if (attempt >= options_.attempts && response.status == 200) throw NoAnswer(why);
    if (attempt >= options_.attempts) throw MethodError(fmt::format("given up after {} attempts: {}", attempt, why));
    const double pause_s = std::max(std::min(wait_s, longest_wait_s), response.retry_after_s);
    const std::string line =
        fmt::format("attempt {} of {}: {}; the next in {:.0f} s", attempt, options_.attempts, why, pause_s);
    if (options_.waiting && connections_->is_new(line)) options_.waiting(line);
    std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
    wait_s *= 2;
  }
}

}  // namespace lgabench
