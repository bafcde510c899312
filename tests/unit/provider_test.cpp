// What providers of language models send: one reply of each form, from a server on loopback.
#include <fmt/format.h>

#include <initializer_list>
#include <utility>

#include <lgabench/abstraction/completion.hpp>
#include <lgabench/abstraction/meaning_reply.hpp>
#include <lgabench/abstraction/server_response.hpp>

#include "chat_server.hpp"

namespace lgabench {
namespace {

using Next = Verdict::Next;

Json with_message(const Json& message, const Json& reason = "stop") {
  return {{"choices", {{{"index", 0}, {"message", message}, {"finish_reason", reason}}}}};
}

Server::Handler always(int status, const std::string& body, const std::string& type = "application/json") {
  return [=](int, const auto&, httplib::Response& response) {
    response.status = status;
    response.set_content(body, type);
    return true;
  };
}

// What the first of five questions is answered by, of one form each: all of them say yes.
TEST_F(Chat, ReadsWhatEachKindOfServerCallsAReply) {
  const Json yes{{"role", "assistant"}, {"content", "Reason.\n\nFinal answer: yes"}};
  const auto and_with = [&](const Json& members) {
    Json message = yes;
    message.update(members);
    return with_message(message);
  };
  const Json thinking{{"type", "thinking"}, {"thinking", {{{"type", "text"}, {"text", "Final answer: no"}}}}},
      text{{"type", "text"}, {"text", "Final answer: yes"}},
      reasoning{{"type", "reasoning"}, {"text", "\nFinal answer: no\n"}};
  const std::vector<std::pair<const char*, Json>> forms{
      {"OpenAI", and_with({{"refusal", nullptr}, {"annotations", Json::array()}})},
      {"a tool's list that is empty", and_with({{"tool_calls", Json::array()}})},
      {"DeepSeek", and_with({{"reasoning_content", "Final answer: no"}})},
      {"vLLM, OpenRouter, Ollama",
       and_with({{"reasoning", "Final answer: no"}, {"tool_calls", nullptr}, {"function_call", nullptr}})},
      {"Anthropic's compatible server", with_message(yes, "stop")},
      {"Mistral", with_message({{"role", "assistant"}, {"content", {thinking, text}}})},
      {"parts of which one is a thought", with_message({{"content", {reasoning, text}}})},
      {"thoughts in the content",
       with_message({{"content", "<think>\nFinal answer: no\n</think>\n\nFinal answer: yes"}})},
      {"thoughts whose beginning is in the prompt", with_message({{"content", "No?\n</think>\n\nFinal answer: yes"}})},
      {"a pleasantry", with_message({{"content", "Final answer: yes\n\nPlease do not hesitate to ask more."}})}};
  for (const auto& [name, body] : forms) {
    fs::remove(tape());
    Server server(always(200, body.dump()));
    const OpenAiOptions options = server.options();
    try {
      EXPECT_EQ(ask(&options).target.product().object_types, space.object_types) << name;
      EXPECT_EQ(server.requests, 5) << name;
    } catch (const MethodError& e) {
      ADD_FAILURE() << name << ": " << e.what();
    }
  }
}

TEST(Completion, IsNoReplyWhereItIsNotWhole) {
  const Json yes{{"content", "Final answer: yes"}}, none{{"content", nullptr}};
  Json calls = none;
  calls["tool_calls"] = {{{"type", "function"}, {"function", {{"name", "grasp"}}}}};
  Json error = with_message(yes, "error");
  error["choices"][0]["error"] = {{"code", 502}, {"message", "provider went away"}};
  const std::vector<std::pair<Json, const char*>> all{
      {with_message(yes, "length"), "cut off: finish_reason is length"},
      {with_message(yes, "MAX_TOKENS"), "cut off: finish_reason is MAX_TOKENS"},
      {with_message(yes, "model_length"), "finish_reason is model_length"},
      {with_message(yes, "content_filter: SAFETY"), "finish_reason is content_filter: SAFETY"},
      {with_message(yes, "insufficient_system_resource"), "finish_reason is insufficient_system_resource"},
      {with_message(yes, "abort"), "finish_reason is abort"},
      {with_message(nullptr, "content_filter"), "finish_reason is content_filter"},
      {with_message(calls), "called a tool, and none was offered"},
      {error, "the server says: provider went away"},
      {with_message(none), "the reply is empty"},
      {with_message(Json::object()), "the reply is empty"},
      {with_message({{"content", {{{"type", "refusal"}, {"refusal", "I won't."}}}}}), "the reply is empty"},
      {with_message({{"content", ""}, {"thinking", "Final answer: yes"}}), "the model only thought, in thinking"},
      {Json{{"error", {{"message", "no"}}}}, "the server says: no"}};
  for (const auto& [body, words] : all)
    EXPECT_SAYS(message_of<NoAnswer>([&body = body] { read_completion(body.dump()); }), words);
  // Another API's reply is none: of Ollama, Anthropic, Gemini and OpenAI's newer one.
  for (const char* other : {R"({"message": {"content": "Final answer: yes"}, "done": true})",
                            R"({"type": "message", "content": [{"type": "text", "text": "Final answer: yes"}]})",
                            R"({"candidates": [{"content": {"parts": [{"text": "Final answer: yes"}]}}]})",
                            R"({"object": "response", "output": []})", "[]", "1", "null"}) {
    const std::string said = message_of<InputError>([other] { read_completion(other); });
    EXPECT_SAYS(said, "expected a member \"choices\", got \"");
    EXPECT_SAYS(said, std::string(other).substr(0, 70));
  }
}

TEST(Completion, SaysWhoAnsweredWhenAndForHowMuch) {
  Json body = with_message({{"content", "yes"}});
  ChatReply reply = read_completion(body.dump());
  EXPECT_EQ(reply.served + reply.day, "");
  EXPECT_EQ(reply.tokens + reply.prompt_tokens + reply.reply_tokens, 0);
  body.update({{"model", "m-2026-01-10"},
               {"created", 1795824000},
               {"usage", {{"prompt_tokens", 600}, {"completion_tokens", 5}, {"total_tokens", 612}}}});
  reply = read_completion(body.dump());
  EXPECT_EQ(reply.served, "m-2026-01-10");
  EXPECT_EQ(reply.day, "2026-11-28");
  EXPECT_EQ(reply.prompt_tokens, 600);
  EXPECT_EQ(reply.reply_tokens, 5);
  EXPECT_EQ(reply.tokens, 612) << "thoughts that the server counts apart";
  body["usage"].erase("total_tokens");
  EXPECT_EQ(read_completion(body.dump()).tokens, 605);
  body.update({{"model", std::string(1000, 'm') + "\n"}, {"created", "today"}, {"usage", nullptr}});
  reply = read_completion(body.dump());
  EXPECT_EQ(reply.served, std::string(200, 'm'));
  EXPECT_EQ(reply.day, "");
}

TEST(Completion, MendsWhatNoJsonTextMayHold) {
  for (const auto& [sent, read] : std::initializer_list<std::pair<std::string, std::string>>{
           {"a \xe9 b", "a \ufffd b"},              // Latin-1
           {"\xe2\x9d", "\ufffd"},                  // a character that is cut
           {"\xed\xa0\x80", "\ufffd\ufffd\ufffd"},  // a surrogate as bytes
           {"\\ud83d", "\ufffd"},                   // half of a pair, as an escape
           {"\\ude00 a", "\ufffd a"},               // the other half
           {"\\ud83d\\ud83d\\ude00", "\ufffd\U0001f600"},
           {"\\uD83D\\uDE00", "\U0001f600"},
           {"\\\\ud83d", "\\ud83d"},  // a backslash, and letters
           {"\\u2764", "\u2764"}}) {
    const std::string body = R"({"choices": [{"message": {"content": ")" + sent + R"("}}]})";
    EXPECT_EQ(read_completion(mended_json(body)).text, read) << sent;
  }
  EXPECT_EQ(mended_json("\\"), "\\");
  EXPECT_EQ(mended_json("\\u"), "\\u");
}

TEST_F(Chat, ABrokenCharacterCostsNoAnswer) {
  for (const char* broken : {"\xe9", "\\ud83d"}) {
    fs::remove(tape());
    Server server(
        always(200, std::string(R"({"choices": [{"message": {"content": ")") + broken + R"(\nFinal answer: yes"}}]})"));
    const OpenAiOptions options = server.options();
    EXPECT_EQ(ask(&options).target.product().object_types, space.object_types);
    EXPECT_EQ(ask(nullptr).target.product().object_types, space.object_types) << "from the cassette";
  }
}

TEST(Completion, CutsBetweenCharacters) {
  EXPECT_EQ(beginning("abc", 3), "abc");
  EXPECT_EQ(beginning("ab\u2764", 4), "ab");
  EXPECT_EQ(beginning("ab\u2764", 5), "ab\u2764");
  EXPECT_EQ(beginning("\u2764", 0), "");
}

// A model is told what is wrong with its reply: in a request, which is UTF-8.
TEST_F(Chat, ACutValueInAComplaintIsStillText) {
  for (const char* before : {"", "a", "aa"}) {
    fs::remove(tape());
    std::string type = before;
    for (int i = 0; i < 40; ++i) type += "\u2764";
    Server server(always(200, with_message({{"content", "Final answer: {\"sets\": \"" + type + "\"}"}}).dump()));
    Cassette cassette(tape());
    OpenAiClient client(server.options());
    ChatLanguageModel model(cassette, &client, {"m"});
    EXPECT_TRUE(select_meaning(command, space, model).empty());
    EXPECT_EQ(server.requests, 3);
  }
}

struct Sent {
  const char* what;
  long status;
  std::string body;
  Next next;
  const char* words;
};

TEST(Verdict, TellsWhatWaitingCanMendFromWhatItCannot) {
  const std::string page = "<!DOCTYPE html>\n<html><head><title>Sign in</title></head><body>\u2764</body></html>",
                    ok = with_message({{"content", "yes"}}).dump();
  const std::vector<Sent> all{
      {"a reply", 200, ok, Next::read, ""},
      {"nothing known", 200, "yes", Next::read, ""},
      {"overloaded", 503, R"({"error": {"code": 503, "message": "Loading model"}})", Next::retry,
       "status 503: Loading model"},
      {"Anthropic overloaded", 529,
       R"({"type": "error", "error": {"type": "overloaded_error", "message": "Overloaded"}})", Next::retry,
       "status 529: Overloaded"},
      {"too many", 429, R"({"error": {"message": "Rate limit reached", "code": "rate_limit_exceeded"}})", Next::retry,
       "status 429: Rate limit reached"},
      {"Gemini", 429, R"([{"error": {"code": 429, "message": "Exhausted", "status": "RESOURCE_EXHAUSTED"}}])",
       Next::retry, "status 429: Exhausted"},
      {"a gateway's page", 502, page, Next::retry, "status 502: \"Sign in \u2764 \""},
      {"TGI", 429, R"({"error": "Model is overloaded", "error_type": "overloaded"})", Next::retry,
       "Model is overloaded"},
      {"no words", 500, "", Next::retry, "status 500"},
      {"an error in a 200", 200, R"({"error": {"message": "model is loading"}})", Next::retry,
       "the server says: model is loading"},
      {"OpenRouter, in a 200", 200, R"({"error": {"code": 502, "message": "down"}})", Next::retry,
       "the server says: down"},
      {"out of credit, as 429", 429,
       R"({"error": {"message": "You exceeded your current quota", "type": "insufficient_quota", "code": "insufficient_quota"}})",
       Next::stop, "status 429: You exceeded your current quota"},
      {"out of credit, of another", 429, R"({"error": {"message": "no", "type": "exceeded_current_quota_error"}})",
       Next::stop, "status 429: no"},
      {"DeepSeek out of credit", 402,
       R"({"error": {"message": "Insufficient Balance", "code": "invalid_request_error"}})", Next::stop,
       "status 402: Insufficient Balance"},
      {"out of credit in a 200", 200, R"({"error": {"code": 402, "message": "Insufficient credits"}})", Next::stop,
       "the server says: Insufficient credits"},
      {"a key", 401, R"({"error": {"message": "Incorrect API key"}})", Next::stop, "status 401: Incorrect API key"},
      {"forbidden", 403, page, Next::stop, "status 403: \"Sign in \u2764 \""},
      {"no such model", 404, R"({"object": "error", "message": "The model m does not exist.", "code": 404})",
       Next::stop, "status 404: The model m does not exist."},
      {"FastAPI", 404, R"({"detail": "Not Found"})", Next::stop, "status 404: Not Found"},
      {"Gemini's key", 400, R"([{"error": {"code": 400, "message": "API key not valid"}}])", Next::stop,
       "status 400: API key not valid"},
      {"a field", 400, R"({"error": {"message": "Unsupported value"}})", Next::stop, "status 400: Unsupported value"},
      {"a file server", 501, page, Next::stop, "status 501: "},
      {"a captive portal", 511, page, Next::stop, "status 511: "},
      {"a filter's", 400, R"({"error": {"code": "content_filter", "message": "filtered"}})", Next::skip,
       "status 400: filtered"},
      {"a login page", 200, page, Next::stop, "answers with a web page, \"Sign in \u2764 \""},
      {"a page of XHTML", 200, "\n<?xml version=\"1.0\"?><HTML>", Next::stop, "answers with a web page, "},
      {"a stream", 200, "data: {\"choices\": []}\n\n", Next::stop, "the server streams, \"data: {"},
      {"a stream that begins with a comment", 200, ": PROCESSING\n\ndata: {}", Next::stop, "the server streams"},
      {"a page in a reply", 200, with_message({{"content", "<html>"}}).dump(), Next::read, ""}};
  for (const Sent& sent : all) {
    const Verdict verdict = verdict_of({sent.status, sent.body, ""}, "");
    EXPECT_EQ(verdict.next, sent.next) << sent.what << ": " << verdict.why;
    EXPECT_SAYS(verdict.why, sent.words);
    EXPECT_LE(verdict.why.size(), 300u) << sent.what;
    EXPECT_NO_THROW(canonical(Json(verdict.why))) << sent.what;
  }
}

TEST(Verdict, WaitsWhereTheServerSaysForHowLongAndNotForHours) {
  const auto after = [](long status, double seconds) {
    ServerResponse busy{status, R"({"error": {"message": "busy"}})", ""};
    busy.retry_after_s = seconds;
    return verdict_of(busy, "");
  };
  EXPECT_EQ(after(429, 600).next, Next::retry);
  EXPECT_EQ(after(429, 7200).next, Next::stop);
  EXPECT_SAYS(after(429, 7200).why, "status 429: busy; the server asks to wait 120 minutes, repeat the command then");
  EXPECT_EQ(after(402, 5).next, Next::retry) << "requests under way have spent what is there";
  EXPECT_EQ(after(402, 0).next, Next::stop);
}

TEST(Verdict, HidesTheKeyWhereverItStands) {
  const std::string secret = "sk-secret-1234567890";
  for (const std::string& body : {std::string(70, 'x') + secret, "<html>" + secret, "data: " + secret,
                                  R"({"error": {"message": ")" + std::string(190, 'x') + secret + "\"}}"})
    for (const long status : {200L, 400L, 503L}) EXPECT_SILENT(verdict_of({status, body, ""}, secret).why, "sk-");
  ServerResponse moved{302, "", ""};
  moved.moved_to = "https://other/?key=" + secret;
  EXPECT_SILENT(verdict_of(moved, secret).why, "sk-");
}

// One question at a time: whether waiting was tried, and whether other questions were.
TEST_F(Chat, StopsAtOnceWhereNeitherWaitingNorAnotherQuestionHelps) {
  const std::vector<std::pair<Server::Handler, const char*>> all{
      {always(200, "<html><body>Please sign in</body></html>", "text/html"),
       "the server answers with a web page, \"Please sign in \""},
      {always(200, "data: {}\n\ndata: [DONE]\n\n", "text/event-stream"), "the server streams"},
      {[](int, const auto&, httplib::Response& response) {
         response.set_redirect("https://elsewhere.example/v1/chat/completions", 308);
         return true;
       },
       "status 308: moved to https://elsewhere.example/v1/chat/completions; set OPENAI_BASE_URL"},
      {always(429, R"({"error": {"message": "no credit", "code": "insufficient_quota"}})"), "status 429: no credit"},
      {always(402, "{}"), "status 402: \"{}\""}};
  for (const auto& [handler, words] : all) {
    Server server(handler);
    OpenAiOptions options = server.options();
    options.waiting = [](const std::string& why) { ADD_FAILURE() << why; };
    EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), words);
    EXPECT_EQ(server.requests, 1) << words;
  }
}

TEST_F(Chat, AnAddressThatIsNoneIsSaidAtOnce) {
  for (const char* url : {"ftp://127.0.0.1:1/v1", "http://no such host/v1"}) {
    OpenAiOptions options;
    options.base_url = url;
    options.waiting = [](const std::string& why) { ADD_FAILURE() << why; };
    EXPECT_THROW(ask(&options, {"m", 1, -1, {}}), MethodError);
  }
  Server plain(always(200, "{}"));
  OpenAiOptions options = plain.options();
  options.base_url.replace(0, 4, "https");
  options.waiting = [](const std::string& why) { ADD_FAILURE() << why; };
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), "no server at https://");
  options.ca_file = "/nonexistent";
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), "TLS: ");
}

// Who answers: another from the n-th request on.
Server::Handler served_until(int last) {
  return [last](int request, const auto&, httplib::Response& response) {
    Json body = with_message({{"content", "Final answer: yes"}});
    body.update({{"model", request <= last ? "m-2026-01-10" : "m-2026-09-30"},
                 {"usage", {{"prompt_tokens", 600}, {"completion_tokens", 5}, {"total_tokens", 605}}}});
    response.set_content(body.dump(), "application/json");
    return true;
  };
}

TEST_F(Chat, KeepsWhoAnsweredAndWhen) {
  Server server(served_until(1000));
  const OpenAiOptions options = server.options();
  EXPECT_EQ(ask(&options).source, "m (served: m-2026-01-10)");
  const Selection replayed = ask(nullptr);
  EXPECT_EQ(replayed.source, "m (served: m-2026-01-10)");
  EXPECT_EQ(replayed.cost.lm_tokens, 5 * 605);
  const std::string text = read_file(tape());
  for (const Json& line : parse_json_lines(text, "tape")) {
    EXPECT_EQ(line.at("model"), "m");
    EXPECT_EQ(line.at("served"), "m-2026-01-10");
    EXPECT_EQ(line.at("day").get<std::string>().size(), 10u);
    EXPECT_EQ(line.at("prompt_tokens"), 600);
    EXPECT_EQ(line.at("reply_tokens"), 5);
    EXPECT_EQ(line.at("tokens"), 605);
  }
}

TEST_F(Chat, StopsWhereAnotherModelIsServedUnlessThatIsAllowed) {
  Server server(served_until(2));
  const OpenAiOptions options = server.options();
  const std::string said = message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); });
  EXPECT_SAYS(said, "the server now names its model \"m-2026-09-30\", the replies in ");
  EXPECT_SAYS(said, "are of \"m-2026-01-10\"");
  EXPECT_SAYS(said, "--any-served");
  EXPECT_EQ(server.requests, 3);
  EXPECT_EQ(parse_json_lines(read_file(tape()), "tape").size(), 2u) << "the other's reply is not kept";
  EXPECT_SAYS(message_of<MethodError>([&] {
                ask(&options, {"m", 1, -1, {}});
              }),
              "m-2026-09-30")
      << "a later process learns it from the file";
  ChatOptions any{"m", 1, -1, {}};
  any.any_served = true;
  EXPECT_EQ(ask(&options, any).source, "m (served: m-2026-01-10, m-2026-09-30)");
  EXPECT_EQ(ask(nullptr).source, "m (served: m-2026-01-10, m-2026-09-30)");
}

TEST_F(Chat, ACassetteOfAnEarlierVersionIsReadAsItWas) {
  {
    Server server;
    const OpenAiOptions options = server.options();
    ask(&options);
  }
  std::string old;
  for (Json line : parse_json_lines(read_file(tape()), "tape")) {
    for (const char* member : {"served", "day", "prompt_tokens", "reply_tokens"}) line.erase(member);
    old += canonical(line) + '\n';
  }
  write_file(tape(), old);
  expect_red_hearts(ask(nullptr));
  EXPECT_EQ(read_file(tape()), old);
  write_file(tape(), old.substr(0, old.size() - 2) + R"(,"served":"a\nb"})" + "\n");
  EXPECT_SAYS(message_of<InputError>([&] { ask(nullptr); }), "line 5: /served: expected one line");
}

TEST(MeaningReply, IsReadBehindThoughtsAndInFences) {
  const std::string object = R"({"sets": [{"object_types": ["heart"], "textures": "ALL"}]})";
  for (const std::string& reply :
       {"Final answer: " + object, "Final answer:\n```json\n" + object + "\n```", object, "```\n" + object + "\n```",
        "<think>Final answer: {\"sets\": []}</think>\nFinal answer: " + object, "{thoughts}</think>" + object,
        "[THINK]{}[/THINK]\n" + object, "Final answer: " + object + "\nDo not hesitate to ask {more}."})
    EXPECT_EQ(meaning_in(reply, space).product().object_types, std::vector<std::string>{"heart"}) << reply;
  EXPECT_THROW(meaning_in("<think>It could be " + object, space), MethodError) << "which was only thought of";
}

}  // namespace
}  // namespace lgabench
