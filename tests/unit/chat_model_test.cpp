// The live language model against a server on loopback that misbehaves on purpose.
#include <httplib.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <set>
#include <thread>

#include <lgabench/core/hash.hpp>

#include "chat_server.hpp"

namespace lgabench {
namespace {

TEST_F(Chat, AsksOneQuestionACandidateAndReplaysThemWithoutAServer) {
  Server server;
  const OpenAiOptions options = server.options();
  const Selection live = ask(&options);
  expect_red_hearts(live);
  EXPECT_EQ(live.provenance, Provenance::live);
  EXPECT_EQ(live.cost.lm_queries, 5);
  EXPECT_EQ(live.cost.lm_tokens, 5 * 7);
  EXPECT_GT(live.cost.lm_seconds, 5 * .02);
  EXPECT_EQ(server.requests, 5);
  EXPECT_EQ(server.authorizations, std::set<std::string>{std::string("Bearer ") + key});
  const std::string system = Json::parse(server.bodies[0])["messages"][0]["content"];
  EXPECT_SAYS(system, "heart, star, pan");
  EXPECT_SAYS(system, "red, blue");

  const Selection replayed = ask(nullptr);
  expect_red_hearts(replayed);
  EXPECT_EQ(replayed.provenance, Provenance::cassette);
  EXPECT_EQ(replayed.cost.lm_seconds, live.cost.lm_seconds) << "what it cost then";
  EXPECT_EQ(server.requests, 5);
  EXPECT_EQ(read_file(tape()).find(key), std::string::npos);
}

TEST_F(Chat, AsksSeveralAtOnceAndNoMore) {
  Server server;
  const OpenAiOptions options = server.options();
  std::vector<int> told;
  expect_red_hearts(ask(&options, {"m", 3, -1, [&](int asked, int all) {
                                     EXPECT_EQ(all, 5);
                                     told.push_back(asked);
                                   }}));
  EXPECT_EQ(server.most_at_once, 3);
  EXPECT_EQ(told.back(), 5);
}

TEST_F(Chat, SpendsNoMoreThanItMay) {
  Server server;
  const OpenAiOptions options = server.options();
  EXPECT_SAYS(message_of<InputError>([&] {
                ask(&options, {"m", 1, 4, {}});
              }),
              "takes 5 queries, expected no more than 4");
  EXPECT_EQ(server.requests, 0);
  expect_red_hearts(ask(&options, {"m", 1, 5, {}}));
}

TEST_F(Chat, GoesOnWhereItStopped) {
  {
    Server server([](int request, const auto&, httplib::Response& response) {
      if (request != 3) return false;
      response.status = 400;
      return true;
    });
    OpenAiOptions options = server.options();
    EXPECT_THROW(ask(&options, {"m", 1, -1, {}}), MethodError);
    EXPECT_EQ(server.requests, 3) << "what was not begun is not asked";
  }
  std::string torn = read_file(tape());
  write_file(tape(), torn.substr(0, torn.size() - 10));  // killed while it wrote the second reply
  Server server;
  const OpenAiOptions options = server.options();
  expect_red_hearts(ask(&options));
  EXPECT_EQ(server.requests, 4);
  EXPECT_SAYS(message_of<InputError>([&] {
                write_file(tape(), "{}\n");
                ask(nullptr);
              }),
              "tape.jsonl: line 1");
}

TEST_F(Chat, TriesAgainWhereThatMayHelp) {
  for (const int status : {408, 409, 429, 500, 503}) {
    fs::remove(tape());
    Server server([status](int request, const auto&, httplib::Response& response) {
      if (request > 2) return false;
      response.status = status;
      return true;
    });
    const OpenAiOptions options = server.options();
    expect_red_hearts(ask(&options, {"m", 1, -1, {}}));
    EXPECT_EQ(server.requests, 7) << status;
  }
}

TEST_F(Chat, WaitsAsLongAsItIsTold) {
  Server server([](int request, const auto&, httplib::Response& response) {
    if (request > 1) return false;
    response.status = 429;
    response.set_header("Retry-After", "1");
    return true;
  });
  const OpenAiOptions options = server.options();
  const auto start = std::chrono::steady_clock::now();
  expect_red_hearts(ask(&options, {"m", 1, -1, {}}));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST_F(Chat, GivesUpAtLast) {
  Server server([](int, const auto&, httplib::Response& response) {
    response.status = 503;
    response.set_content("{\"error\": {\"message\": \"overloaded\"}}", "application/json");
    return true;
  });
  EXPECT_SAYS(failure(server, 3), "given up after 3 attempts: status 503: overloaded");
}

TEST_F(Chat, RefusalsAreFinalAndHideTheKey) {
  for (const int status : {400, 401, 403, 404}) {
    Server server([status](int, const auto&, httplib::Response& response) {
      response.status = status;
      response.set_content(std::string("{\"error\": {\"message\": \"Incorrect API key\\nprovided: ") + key + "\"}}",
                           "application/json");
      return true;
    });
    EXPECT_SAYS(failure(server), "status " + std::to_string(status) + ": Incorrect API key provided: (key)");
    EXPECT_LE(server.requests, 4) << "one attempt for each that was under way";
  }
}

TEST_F(Chat, AnAnswerThatIsCutOffOrNoneIsNeverANo) {
  const auto failure_of = [this](const std::string& body) {
    Server server([body](int, const auto&, httplib::Response& response) {
      response.set_content(body, "application/json");
      return true;
    });
    return failure(server);
  };
  EXPECT_SAYS(failure_of(completion("Final answer: yes", "length")), "cut off: finish_reason is length");
  EXPECT_SAYS(failure_of(completion("Final answer: yes", "content_filter")), "finish_reason is content_filter");
  EXPECT_SAYS(failure_of(completion("Final answer: yes", "tool_calls")),
              "the model called a tool, and none was offered: finish_reason is tool_calls");
  EXPECT_SAYS(failure_of(completion("I would say so.")), "expected a last line \"Final answer: yes\"");
  EXPECT_SAYS(failure_of(completion("Final answer: yes\nor rather not")),
              "that ends \"Final answer: yes\nor rather not\"");
  EXPECT_SAYS(failure_of("not JSON"), "language model's reply");
  EXPECT_SAYS(failure_of("{\"choices\": []}"), "/choices: expected one choice");
  const auto null_content = [](const Json& refusal) {
    return Json{{"choices", {{{"finish_reason", "stop"}, {"message", {{"content", nullptr}, {"refusal", refusal}}}}}}}
        .dump();
  };
  EXPECT_SAYS(failure_of(null_content(nullptr)), "the reply is empty");
  EXPECT_SAYS(failure_of(completion(" \n")), "the reply is empty");
  for (const char* member : {"reasoning_content", "reasoning"})
    EXPECT_SAYS(failure_of(Json{{"choices", {{{"message", {{"content", ""}, {member, "Final answer: yes"}}}}}}}.dump()),
                std::string("the reply is empty: the model only thought, in ") + member);
  EXPECT_SAYS(failure_of(null_content("I cannot help with hearts.")), "the model refused: I cannot help with hearts.");
  EXPECT_EQ(read_file(tape()), "") << "what cannot be read is not kept";
}

TEST_F(Chat, AReplyWithoutAnAnswerIsAskedForAgain) {
  std::atomic<int> about_star{0};
  const auto evasive_until = [&about_star](int tries, bool other_words) {
    return [&about_star, tries, other_words](int, const httplib::Request& request, httplib::Response& response) {
      if (request.body.find("\\\"star\\\"?") == std::string::npos || ++about_star > tries) return false;
      const std::string time = other_words ? std::to_string(about_star) : "";
      response.set_content(completion("I would not say so." + time), "application/json");
      return true;
    };
  };
  {
    Server never(evasive_until(1000, true));
    EXPECT_SAYS(failure(never),
                "1 of 5 questions have no answer from m: \"star\"; the first: \"Bring me the red heart.\", asked about "
                "\"star\": language model: expected a last line");
    EXPECT_EQ(never.requests, 4 + 3) << "the others are asked and kept";
  }
  fs::remove(tape());
  Server stubborn(evasive_until(1000, false));
  EXPECT_SAYS(failure(stubborn), "(asked 2 times)");
  EXPECT_EQ(stubborn.requests, 4 + 2) << "what says the same twice says it a third time";
  about_star = 0;
  Server late(evasive_until(2, true));
  const OpenAiOptions options = late.options();
  EXPECT_EQ(ask(&options).target.product().object_types, std::vector<std::string>{"heart"});
  EXPECT_EQ(late.requests, 3) << "about the star alone";
}

TEST_F(Chat, AReplyWithoutAnAnswerStopsNoOtherQuestion) {
  // Each of two questions, in its own way and always the same, as at temperature 0.
  const auto misbehave = [](int, const httplib::Request& request, httplib::Response& response) {
    if (request.body.find("\\\"star\\\"?") != std::string::npos)
      response.set_content(completion("It is", "length"), "application/json");
    else if (request.body.find("\\\"blue\\\"?") != std::string::npos)
      response.set_content("blue", "text/plain");
    else
      return false;
    return true;
  };
  Server server(misbehave);
  const OpenAiOptions options = server.options();
  for (const int requests : {5, 7}) {
    try {
      ask(&options, {"m", 1, -1, {}});
      ADD_FAILURE() << "no answer was taken for one";
    } catch (const Unanswered& e) {
      EXPECT_SAYS(std::string(e.what()), "questions have no answer from m: \"star\", \"blue\"; the first: ");
      ASSERT_EQ(e.questions.size(), 2u);
      EXPECT_EQ(e.questions[0],
                "\"Bring me the red heart.\", asked about \"star\": the reply was cut off: finish_reason is length");
      EXPECT_SAYS(e.questions[1],
                  "asked about \"blue\": language model's reply: byte 1: expected valid JSON, got \"blue\"");
    }
    EXPECT_EQ(server.requests, requests) << "each once, and what was answered not again";
  }
}

TEST_F(Chat, AModelThatAnswersNothingIsNotAskedOn) {
  FeatureSpace large = space;
  for (int i = 0; i < 95; ++i) large.textures.push_back("texture " + std::to_string(i));
  Server server([](int, const auto&, httplib::Response& response) {
    response.set_content(completion("Yes."), "application/json");
    return true;
  });
  Cassette cassette(tape());
  OpenAiClient client(server.options());
  ChatLanguageModel model(cassette, &client, {"m"});
  EXPECT_EQ(model.open_questions(command, large, feature_questions(command, large)), 100);
  EXPECT_SAYS(
      message_of<MethodError>([&] { select_features(command, large, model); }),
      "m: none of its first 20 replies has an answer, lgabench stopped asking; the last: language model: expected");
  EXPECT_LE(server.requests, 2 * (20 + 4)) << "each twice, and those that were under way";
}

TEST_F(Chat, KeepsItsConnections) {
  std::mutex mutex;
  std::set<int> ports;
  Server server([&](int, const httplib::Request& request, httplib::Response&) {
    const std::lock_guard lock(mutex);
    ports.insert(request.remote_port);
    return false;
  });
  const OpenAiOptions options = server.options();
  expect_red_hearts(ask(&options, {"m", 1, -1, {}}));
  EXPECT_EQ(ports.size(), 1u);
}

TEST_F(Chat, WaitsFiveMinutesWhereTheServerSaysSo) {
  Server server([](int, const auto&, httplib::Response& response) {
    response.status = 429;
    response.set_header("Retry-After", "300");
    return true;
  });
  OpenAiOptions options = server.options();
  options.waiting = [](const std::string& why) { throw MethodError(why); };  // rather than wait here
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), "the next in 300 s");
}

TEST_F(Chat, AnErrorInsideAReplyIsToldInTheServersWords) {
  for (const char* body : {R"({"error": {"message": "model is loading"}})", R"({"error": "model is loading"})"}) {
    Server server([body](int, const auto&, httplib::Response& response) {
      response.set_content(body, "application/json");
      return true;
    });
    EXPECT_SAYS(failure(server), "the server says: model is loading");
  }
  // It may have loaded by the next attempt; an error that is the request's own is not asked again.
  Server loading([](int request, const auto&, httplib::Response& response) {
    if (request == 1)
      response.set_content(R"({"error": {"message": "model is loading", "code": 503}})", "application/json");
    return request == 1;
  });
  const OpenAiOptions options = loading.options();
  expect_red_hearts(ask(&options, {"m", 1, -1, {}}));
  EXPECT_EQ(loading.requests, 5 + 1);
  Server refusing([](int, const auto&, httplib::Response& response) {
    response.set_content(R"({"error": {"message": "no such field", "code": 400}})", "application/json");
    return true;
  });
  fs::remove(tape());
  EXPECT_SAYS(failure(refusing), "the server says: no such field");
  EXPECT_LE(refusing.requests, 4) << "as after a status of 400: one attempt for each that was under way";
}

TEST_F(Chat, AWholeReplyIsReadWhateverTheServerCallsIt) {
  const Json plain{{"role", "assistant"}, {"content", "Final answer: yes"}},
      parts{{"content", {{{"type", "text"}, {"text", "Final "}}, {{"type", "text"}, {"text", "answer: yes"}}}}};
  const std::vector<Json> choices{{{"message", plain}},
                                  {{"message", plain}, {"finish_reason", nullptr}},
                                  {{"message", parts}},
                                  {{"message", plain}, {"finish_reason", "eos_token"}},
                                  {{"message", plain}, {"finish_reason", "STOP"}}};
  for (const Json& usage : {Json(), Json{{"total_tokens", 640.0}}, Json{{"total_tokens", "many"}}, Json::array()})
    for (const Json& choice : choices) {
      fs::remove(tape());
      Server server([&](int, const auto&, httplib::Response& response) {
        response.set_content(Json{{"choices", {choice}}, {"usage", usage}}.dump(), "application/json");
        return true;
      });
      const OpenAiOptions options = server.options();
      const Selection selection = ask(&options);
      EXPECT_EQ(selection.target.product().object_types, space.object_types) << choice;
      EXPECT_EQ(selection.cost.lm_tokens, usage.is_object() && usage["total_tokens"].is_number() ? 5 * 640 : 0);
    }
}

TEST_F(Chat, ASlowReplyIsWaitedForAndALateOneConcernsItsQuestionAlone) {
  Server server([](int, const httplib::Request& request, httplib::Response&) {
    if (request.body.find("\\\"star\\\"?") != std::string::npos) std::this_thread::sleep_for(std::chrono::seconds(2));
    return false;
  });
  OpenAiOptions options = server.options();
  EXPECT_EQ(OpenAiOptions().timeout_s, 600);
  options.timeout_s = 1;
  EXPECT_SAYS(message_of<Unanswered>([&] { ask(&options); }), "\"star\": no reply within 1 s (--reply-timeout)");
  EXPECT_EQ(server.requests, 5) << "a server that is slow is not asked twice";
  options.timeout_s = 3;  // no byte comes for more than half of it
  expect_red_hearts(ask(&options));
  EXPECT_EQ(server.requests, 6);
}

TEST_F(Chat, FieldsOfTheRequestAreLeftOutAndAdded) {
  Server server([](int, const httplib::Request& request, httplib::Response& response) {
    if (!Json::parse(request.body).contains("temperature")) return false;
    response.status = 400;
    response.set_content(R"({"error": {"message": "Unsupported value: 'temperature'"}})", "application/json");
    return true;
  });
  const OpenAiOptions options = server.options();
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), "Unsupported value: 'temperature'");
  const std::string model =
      to_text(asked_model("m", R"({"reasoning": {"effort": "low"}, "seed": 1, "temperature": null})"));
  EXPECT_EQ(model, R"(m {"reasoning":{"effort":"low"},"seed":1,"temperature":null})");
  EXPECT_EQ(to_text(read_asked_model(model)), model);
  const auto ask_with = [&](ChatClient* client) {
    Cassette cassette(tape());
    ChatLanguageModel asked(cassette, client, {client ? model : cassette.only_model()});
    return select_features(command, space, asked);
  };
  OpenAiClient client(options);
  EXPECT_EQ(ask_with(&client).source, model);
  const Json sent = Json::parse(server.bodies.back());
  EXPECT_FALSE(sent.contains("temperature"));
  EXPECT_EQ(sent.at("seed"), 1);
  EXPECT_EQ(sent.at("reasoning"), Json({{"effort", "low"}}));
  EXPECT_EQ(sent.at("model"), "m");
  const Selection replayed = ask_with(nullptr);
  EXPECT_EQ(replayed.target, (FeatureSet{{"heart"}, {"red"}}));
  EXPECT_EQ(replayed.source, model) << "the cassette tells";
  EXPECT_SAYS(message_of<InputError>([&] { ask(nullptr); }), "5 of 5 are missing") << "another request, another answer";
}

TEST(AskedModel, IsItsNameAndWhatIsNotTheUsualRequest) {
  for (const char* nothing : {"", "{}", R"({"temperature": 0})", R"({"seed": null})"})
    EXPECT_EQ(to_text(asked_model("a/b:8b", nothing)), "a/b:8b") << nothing;
  EXPECT_EQ(to_text(asked_model("m", R"({"stop": ["x", null]})")), R"(m {"stop":["x",null]})");
  EXPECT_EQ(command_words(asked_model("m", R"({"user": "d'Arc"})")), R"(--model m --request '{"user":"d\u0027Arc"}')");
  EXPECT_EQ(command_words(read_asked_model("m")), "--model m");
  for (const auto& [patch, complaint] :
       {std::pair{"[]", "--request: /: expected an object"},
        {"{", "--request: byte"},
        {R"({"model": "n"})", "--request: /model: expected no such member, which lgabench sets"},
        {R"({"messages": []})", "--request: /messages: expected"},
        {R"({"stream": true})", "--request: /stream: expected"}})
    EXPECT_SAYS(message_of<InputError>([patch = patch] { asked_model("m", patch); }), complaint);
  EXPECT_SAYS(message_of<InputError>([] { asked_model("m {}", ""); }), "--model m {}: expected no \" {\" in it");
}

TEST_F(Chat, AReplyWithoutEndOrBottomIsRefused) {
  Server endless([](int, const auto&, httplib::Response& response) {
    response.set_chunked_content_provider("application/json", [](std::size_t, httplib::DataSink& sink) {
      const std::string block(1 << 16, ' ');
      return sink.write(block.data(), block.size());
    });
    return true;
  });
  EXPECT_SAYS(failure(endless), "a reply of more than 4194304 bytes");
  EXPECT_LE(endless.requests, 4) << "one attempt for each that was under way";
  for (const std::string& body : {std::string(300000, '['), R"({"choices": )" + std::string(300000, '[') + "}"})
    for (const int status : {200, 400}) {
      Server deep([&](int, const auto&, httplib::Response& response) {
        response.status = status;
        response.set_content(body, "application/json");
        return true;
      });
      EXPECT_SAYS(failure(deep), status == 200 ? "language model's reply: /" : "status 400: ");
    }
}

TEST_F(Chat, TheKeyIsInNoMessageAndNoReply) {
  const auto server_that_says = [](const std::string& text, const std::string& reason) {
    return [=](int, const httplib::Request&, httplib::Response& response) {
      response.set_content(completion(text, reason), "application/json");
      return true;
    };
  };
  {
    Server server([](int, const auto&, httplib::Response& response) {
      const Json message{{"content", nullptr}, {"refusal", std::string("no credit on ") + key}};
      response.set_content(Json{{"choices", {{{"message", message}}}}}.dump(), "application/json");
      return true;
    });
    EXPECT_SAYS(failure(server), "the model refused: no credit on (key)");
  }
  {
    Server server(server_that_says(std::string("You are ") + key, "stop"));
    failure(server);
  }
  {  // at the end of what is shown of a message
    Server server([](int, const auto&, httplib::Response& response) {
      response.status = 400;
      response.set_content(std::string(190, 'x') + key, "text/plain");
      return true;
    });
    EXPECT_SILENT(failure(server), "sk-");
  }
  Server server(server_that_says(std::string("You are ") + key + ".\nFinal answer: yes", "stop"));
  const OpenAiOptions options = server.options();
  ask(&options);
  EXPECT_SAYS(read_file(tape()), "You are (key).");
  EXPECT_SILENT(read_file(tape()), key);
  // Words of the reply and of its form, as placeholders are.
  for (const char* word : {"k", "You", "message", "assistant"}) {
    OpenAiOptions odd = server.options();
    odd.api_key = word;
    fs::remove(tape());
    ask(&odd);
    EXPECT_SAYS(read_file(tape()), "You are ");
  }
}

TEST(Provider, IsNamedWithoutTheNameAndPasswordInItsAddress) {
  const auto of = [](const char* url) {
    OpenAiOptions options;
    options.base_url = url;
    return provider(options);
  };
  EXPECT_EQ(of("https://me:secret@host:8000/v1"), "https://host:8000/v1");
  EXPECT_EQ(of("https://a@b:secret@host/v1"), "https://host/v1");
  EXPECT_EQ(of("me:secret@host"), "host");
  EXPECT_EQ(of("https://host/v1/@x"), "https://host/v1/@x");
}

TEST_F(Chat, TwoWhoAskTakeTurnsAndPayOnce) {
  Server server;
  const OpenAiOptions options = server.options();
  std::atomic<int> waited{0};
  std::vector<std::thread> both;
  for (int i = 0; i < 2; ++i)
    both.emplace_back([&] { expect_red_hearts(ask(&options, {"m", 1, -1, {}, [&](const auto&) { ++waited; }})); });
  for (std::thread& one : both) one.join();
  EXPECT_EQ(server.requests, 5);
  EXPECT_LE(waited, 1);
  const std::string lines = read_file(tape());
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 5);
}

TEST_F(Chat, SaysWhatItWaitsFor) {
  Server server([](int request, const auto&, httplib::Response& response) {
    if (request > 1) return false;
    response.status = 503;
    return true;
  });
  OpenAiOptions options = server.options();
  std::string said;
  options.waiting = [&](const std::string& why) { said = why; };
  ask(&options, {"m", 1, -1, {}, {}});
  EXPECT_SAYS(said, "attempt 1 of 6: status 503");
}

TEST_F(Chat, ABrokenConnectionIsTriedAgain) {
  Server server([](int request, const auto&, httplib::Response& response) {
    if (request > 1) return false;
    response.set_content_provider(1000, "application/json", [](std::size_t, std::size_t, httplib::DataSink& sink) {
      sink.write("{\"choices\"", 10);
      return false;  // closed before the length that was promised
    });
    return true;
  });
  const OpenAiOptions options = server.options();
  expect_red_hearts(ask(&options, {"m", 1, -1, {}}));
  EXPECT_EQ(server.requests, 6);
}

TEST_F(Chat, ASlowTrickleEnds) {
  Server server([](int, const auto&, httplib::Response& response) {
    response.set_chunked_content_provider("application/json", [](std::size_t, httplib::DataSink& sink) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      return sink.write(" ", 1);
    });
    return true;
  });
  OpenAiOptions options = server.options();
  options.attempts = 1;
  options.timeout_s = 1;
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), "no reply within 1 s");
}

TEST_F(Chat, NoServerAndNoTlsAreSaid) {
  OpenAiOptions nowhere;
  {
    Server server;
    nowhere = server.options();
    nowhere.attempts = 1;
    OpenAiOptions tls = nowhere;
    tls.base_url.replace(0, 4, "https");
    EXPECT_SAYS(message_of<MethodError>([&] { ask(&tls); }), "/v1: TLS: ");
    OpenAiOptions file = nowhere;
    file.base_url = "file:///etc";
    EXPECT_THROW(ask(&file), MethodError);
  }
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&nowhere); }), "no server at http://127.0.0.1:");
}

// A server over TLS with a certificate that nobody but itself vouches for.
class SelfSignedServer {
 public:
  SelfSignedServer() : key_(EVP_RSA_gen(2048)), certificate_(X509_new()) {
    ASN1_INTEGER_set(X509_get_serialNumber(certificate_), 1);
    X509_gmtime_adj(X509_getm_notBefore(certificate_), 0);
    X509_gmtime_adj(X509_getm_notAfter(certificate_), 3600);
    X509_set_pubkey(certificate_, key_);
    X509_NAME* name = X509_get_subject_name(certificate_);
    X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>("127.0.0.1"), -1, -1,
                               0);
    X509_set_issuer_name(certificate_, name);
    X509_sign(certificate_, key_, EVP_sha256());
    server_ = std::make_unique<httplib::SSLServer>(certificate_, key_);
    server_->Post("/v1/chat/completions", [this](const httplib::Request&, httplib::Response& response) {
      ++requests;
      response.set_content(completion("Final answer: yes"), "application/json");
    });
    port = server_->bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_->listen_after_bind(); });
  }
  ~SelfSignedServer() {
    server_->stop();
    thread_.join();
    X509_free(certificate_);
    EVP_PKEY_free(key_);
  }

  void write_certificate(const fs::path& file) const {
    FILE* const out = std::fopen(file.c_str(), "w");
    PEM_write_X509(out, certificate_);
    std::fclose(out);
  }

  std::atomic<int> requests{0};
  int port = 0;

 private:
  EVP_PKEY* key_;
  X509* certificate_;
  std::unique_ptr<httplib::SSLServer> server_;
  std::thread thread_;
};

TEST_F(Chat, ACertificateThatNobodyTrustsEndsItBeforeTheKeyIsSent) {
  SelfSignedServer server, other;
  OpenAiOptions options;
  options.base_url = "https://127.0.0.1:" + std::to_string(server.port) + "/v1";
  options.api_key = key;
  options.first_wait_s = 30;  // another attempt would be noticed
  for (const fs::path& ca_file : {fs::path(), path / "others.pem"}) {
    if (!ca_file.empty()) other.write_certificate(ca_file);
    options.ca_file = ca_file;
    EXPECT_SAYS(message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); }), "TLS: ");
  }
  const std::string said = message_of<MethodError>([&] { ask(&options, {"m", 1, -1, {}}); });
  EXPECT_SAYS(said, "certificate");
  EXPECT_SILENT(said, key);
  EXPECT_EQ(server.requests, 0);
  EXPECT_EQ(read_file(tape()), "");
}

TEST_F(Chat, ACertificateThatAFileNamesIsTrusted) {
  SelfSignedServer server;
  server.write_certificate(path / "authority.pem");
  ASSERT_EQ(::setenv("OPENAI_BASE_URL", ("https://127.0.0.1:" + std::to_string(server.port) + "/v1").c_str(), 1), 0);
  ASSERT_EQ(::setenv("SSL_CERT_FILE", (path / "authority.pem").c_str(), 1), 0);
  OpenAiOptions options = openai_from_environment();
  ::unsetenv("OPENAI_BASE_URL");
  ::unsetenv("SSL_CERT_FILE");
  options.attempts = 1;
  ask(&options);
  EXPECT_EQ(server.requests, 5);
}

// What a proxy would be asked for; none is, as nobody listens there.
class Proxy {
 public:
  explicit Proxy(const std::string& url) {
    for (const char* name : {"http_proxy", "https_proxy"}) ::setenv(name, url.c_str(), 1);
  }
  ~Proxy() {
    for (const char* name : {"http_proxy", "https_proxy"}) ::unsetenv(name);
  }
};

TEST_F(Chat, ThisMachineIsAskedPastTheProxyAndOthersSayThatItIsBetween) {
  const Proxy proxy("http://me:secret@127.0.0.1:9");
  Server server;
  const OpenAiOptions options = server.options();
  expect_red_hearts(ask(&options));
  for (const char* elsewhere : {"http://models.invalid/v1", "https://models.invalid/v1"}) {
    OpenAiOptions other = options;
    other.base_url = elsewhere;
    other.attempts = 1;
    fs::remove(tape());
    const std::string said = message_of<MethodError>([&] { ask(&other); });
    EXPECT_SAYS(said, ", through the proxy http://127.0.0.1:9");
    EXPECT_SILENT(said, "secret");
  }
}

TEST_F(Chat, WhereNobodyListensIsSaidAtOnceAndWhatAllWaitForOnce) {
  OpenAiOptions options;
  {
    std::atomic<int> said{0};
    Server server([](int, const auto&, httplib::Response& response) {
      response.status = 503;
      return true;
    });
    options = server.options();
    options.attempts = 2;
    options.waiting = [&](const std::string&) { ++said; };
    EXPECT_SAYS(message_of<MethodError>([&] { ask(&options); }), "given up after 2 attempts: status 503");
    EXPECT_EQ(said, 1) << "for all of the threads";
  }
  int attempts = 0;
  options.waiting = [&](const std::string&) { ++attempts; };
  const std::string nobody = message_of<MethodError>([&] { ask(&options); });
  EXPECT_SAYS(nobody, "no server at http://127.0.0.1:");
  EXPECT_SILENT(nobody, " ms") << "each thread's time would be said anew";
  EXPECT_EQ(attempts, 0);
  options.was_there = true;
  EXPECT_SAYS(message_of<MethodError>([&] { ask(&options); }), "given up after 2 attempts: ");
  EXPECT_EQ(attempts, 1);
}

TEST(Prompt, AsksOfTheTargetOrTheObstacleAndFillsInEachPlaceOnce) {
  const PromptTemplate prompt;
  const Command braces = command_of("sweep", "Bring me {candidate}.");
  const Prompt p = prompt.fill(braces, space, {Question::About::second, Question::Group::texture, "red"});
  EXPECT_SAYS(p.user, "\"Bring me {candidate}.\"");
  EXPECT_SAYS(p.user, "Could the object to be avoided have the object color \"red\"?");
  EXPECT_SAYS(prompt.fill(command, space, {Question::About::target, Question::Group::object_type, "pan"}).user,
              "Could the target object have the object type \"pan\"?");
  EXPECT_EQ(p.user.find("{group}"), std::string::npos);
  EXPECT_EQ(prompt.version().size(), 64u);
}

TEST(Prompt, OneOfOnesOwnHasEachPlaceholderAndNoOther) {
  const fs::path file = fs::path(testing::TempDir()) / "prompt_of_ones_own.txt";
  const std::string whole =
      "Types {object_types}, looks {textures}.\n---\n\"{command}\": {about}, {group} {candidate}?";
  const auto refused = [&](const std::string& text) {
    write_file(file, text);
    return message_of<InputError>([&] { read_prompt(file); }).substr(file.string().size());
  };
  write_file(file, whole + " {\"json\": {}}");
  const PromptTemplate own = PromptTemplate::of_text(read_prompt(file));
  EXPECT_EQ(own.version(), sha256_file(file));
  EXPECT_SAYS(own.fill(command, space, {{}, {}, "pan"}).user, "the target object, object type pan? {\"json\": {}}");
  EXPECT_EQ(refused(""),
            ": expected a prompt with {object_types}, {textures}, {command}, {about}, {group}, {candidate}, "
            "the file is empty");
  EXPECT_SAYS(refused(" \n"), "the file is empty");
  EXPECT_EQ(refused("{object_types}{command}\n---\n{about} {group}"), ": expected {textures}, {candidate} in it too");
  EXPECT_EQ(refused("\n" + whole + "{colour}"),
            ": line 4: expected {object_types}, {textures}, {command}, {about}, "
            "{group}, {candidate}, got {colour}");
  EXPECT_EQ(refused("{object_types}{textures}{command}{about}{group}{candidate}"),
            ": expected a line --- between system and user prompt");
  EXPECT_EQ(refused(whole + "\xff"), ": expected UTF-8");
  EXPECT_SAYS(refused(whole + std::string(1 << 16, ' ')), "65536");
}

// A cassette's replies are to one prompt, and it says to which.
TEST_F(Chat, AnotherPromptTakesAnotherCassette) {
  const std::string text = "{object_types}{textures}\n---\n{command}{about}{group}{candidate}";
  struct Yes : ChatClient {
    ChatReply complete(const Json&) override { return {"Final answer: yes", 1, 1}; }
  } yes;
  const auto ask = [&](const std::string& prompt, ChatClient* client, const fs::path& file) {
    Cassette cassette(file);
    ChatOptions options{client ? to_text(asked_model("m", "", prompt)) : cassette.only_model()};
    if (client) options.prompt = prompt;
    ChatLanguageModel model(cassette, client, options);
    model.answer(command, space, {{{}, {}, "heart"}, {{}, {}, "star"}});
    return model.model();
  };
  const std::string named = "m (prompt " + sha256(text) + ")";
  EXPECT_EQ(to_text(read_asked_model(named)), named);
  EXPECT_EQ(ask(text, &yes, tape()), named);
  EXPECT_EQ(ask(text, nullptr, tape()), named) << "the cassette has the words";
  const std::string first = read_file(tape());
  const Json lines = parse_json_lines(first, "tape");
  EXPECT_EQ(lines.at(0).at("prompt"), text);
  EXPECT_FALSE(lines.at(1).contains("prompt"));
  const auto other = [&](const std::string& prompt) {
    return message_of<InputError>([&] { ask(prompt, &yes, tape()); });
  };
  EXPECT_SAYS(other(""), "expected replies to lgabench's own prompt, it has those to the prompt " + sha256(text));
  EXPECT_SAYS(other(text + "!"), "expected replies to the prompt " + sha256(text + "!"));
  write_file(tape(), first.substr(first.find('\n') + 1) + first);
  EXPECT_SAYS(message_of<InputError>([&] { Cassette cassette(tape()); }), "line 2: /prompt: expected the first line's");
}

// What the server says to the question what the command means, by the number of its asking.
TEST_F(Chat, AsksForAMeaningUntilItCanBeRead) {
  const std::vector<std::string> replies{
      "I am not sure.", R"(Final answer: {"sets": [{"object_types": ["hart"], "textures": "ALL"}]})",
      "Final answer:\n```json\n{\"sets\": [{\"object_types\": [\"heart\"], \"textures\": "
      "\"ALL\"}], \"which\": {\"rule\": \"leftmost\"}}\n```"};
  Server server([&](int request, const httplib::Request&, httplib::Response& response) {
    response.set_content(completion(replies[static_cast<std::size_t>(std::min(request, 3) - 1)]), "application/json");
    return true;
  });
  const auto mean = [&](bool live) {
    Cassette cassette(tape());
    OpenAiClient client(server.options());
    ChatLanguageModel model(cassette, live ? &client : nullptr, {"m"});
    const Selection selection = select_meaning(command, space, model);
    EXPECT_EQ(selection.cost.lm_queries, 3);
    return selection.target;
  };
  const Meaning asked = mean(true);
  ASSERT_TRUE(asked.which);
  EXPECT_EQ(asked.which->rule, Which::Rule::leftmost);
  EXPECT_EQ(server.requests, 3);
  EXPECT_SAYS(server.bodies[2], "hart");
  EXPECT_SAYS(server.bodies[2], "cannot be read");
  EXPECT_EQ(mean(false), asked) << "from the cassette";
}

TEST_F(Chat, AsksHowObjectsAreUsedWhereThatMatters) {
  Server server([](int, const httplib::Request& request, httplib::Response& response) {
    const bool asks = request.body.find("only_if_nothing") != std::string::npos;
    response.set_content(
        completion(
            asks ? R"(Final answer: {"turns": [{"sets": [{"object_types": ["heart"], "textures": "ALL"}], "take": 2, )"
                   R"("same": ["texture"]}]})"
                 : R"(Final answer: {"object_types": ["heart"], "textures": "ALL"})"),
        "application/json");
    return true;
  });
  Cassette cassette(tape());
  OpenAiClient client(server.options());
  ChatLanguageModel model(cassette, &client, {"m"});
  const auto turns = [&](bool may_stop) {
    Command asked = command;
    asked.may_stop = may_stop;
    return select_meaning(asked, space, model).target.turns.size();
  };
  EXPECT_EQ(turns(false), 0U);
  EXPECT_EQ(turns(true), 1U);
}

TEST_F(Chat, IsEmptyWhereNoMeaningCanBeRead) {
  Server server([](int, const httplib::Request&, httplib::Response& response) {
    response.set_content(completion("Final answer: the heart"), "application/json");
    return true;
  });
  Cassette cassette(tape());
  OpenAiClient client(server.options());
  ChatLanguageModel model(cassette, &client, {"m"});
  EXPECT_TRUE(select_meaning(command, space, model).empty());
  EXPECT_EQ(server.requests, 3) << "asked again twice at most";
}

TEST_F(Chat, AsksForHypothesesUntilTheyCanBeRead) {
  const std::string hearts = R"({"text": "Hearts.", "meaning": {"object_types": ["heart"], "textures": "ALL"}})";
  const std::vector<std::string> replies{"Final answer: {\"hypotheses\": []}",
                                         "Final answer: {\"hypotheses\": [" + hearts + R"(, {"text": "Stars."}]})",
                                         "Some {thoughts}.\nFinal answer:\n{\"hypotheses\": [" + hearts + "]}"};
  Server server([&](int request, const httplib::Request&, httplib::Response& response) {
    response.set_content(completion(replies[static_cast<std::size_t>(std::min(request, 3) - 1)]), "application/json");
    return true;
  });
  const auto asked = [&](bool live) {
    Cassette cassette(tape());
    OpenAiClient client(server.options());
    ChatLanguageModel model(cassette, live ? &client : nullptr, {"m"});
    std::vector<Hypothesis> all = model.hypotheses(command, space);
    EXPECT_EQ(model.cost().lm_queries, all.empty() ? 0 : 3);
    return all;
  };
  EXPECT_TRUE(asked(false).empty()) << "nobody can be asked";
  const std::vector<Hypothesis> all = asked(true);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].text, "Hearts.");
  EXPECT_EQ(all[0].meaning.product().object_types, std::vector<std::string>{"heart"});
  EXPECT_EQ(server.requests, 3);
  EXPECT_SAYS(server.bodies[0], "unstated preferences");
  EXPECT_SAYS(server.bodies[1], "/hypotheses: expected 1 to 50 hypotheses");
  EXPECT_SAYS(server.bodies[2], "/hypotheses/1");
  EXPECT_EQ(asked(false).size(), 1u) << "from the cassette";
}

}  // namespace
}  // namespace lgabench
