// How a language model's reply is read.
#include <lgabench/abstraction/final_answer.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

TEST(FinalAnswer, IsReadFromTheEndingsThatModelsWrite) {
  for (const char* yes : {"Final answer: yes",
                          "reasons\nfinal answer: YES.\n\n",
                          "**Final answer:** yes",
                          "Final Answer: **Yes**  ",
                          "a\r\nFinal answer: yes\r\n",
                          "Final answer: yes\n```",
                          "Final answer: yes<|eot_id|>",
                          "Final answer: yes\n</s>",
                          "Final answer: yes<|im_end|>\n",
                          "Final answer: yes, because hearts are red.",
                          "Final answer:\u00a0yes",
                          "Final answer\uff1a yes",
                          "Final answer: \u2705 yes",
                          "Final answer: yes \U0001f600",
                          "\\boxed{Final answer: yes}",
                          "Final answer: $\\boxed{\\text{yes}}$",
                          "\\[ \\text{Final answer: yes} \\]",
                          "Final answer: yes\nLet me know if you want another command judged!",
                          "Reason.\nFinal answer: yes\n\nPlease do not hesitate to ask more.",
                          "Final answer: yes. Please do not hesitate to ask more.",
                          "Final answer: yes! If you have no further questions, I am done.",
                          "Final answer: yes\nNot sure? Ask me.",
                          "**Final answer:** yes\n\nIf you have no further questions, I am done.",
                          "[THINK]Final answer: no[/THINK]Final answer: yes",
                          "\u25c1think\u25b7\nFinal answer: no\n\u25c1/think\u25b7Final answer: yes",
                          "<|channel|>analysis<|message|>\nFinal answer: "
                          "no<|end|><|start|>assistant<|channel|>final<|message|>Final answer: yes",
                          "Final answer: no was my first thought.\n</think>\nFinal answer: yes",
                          "Final answer:\nyes",
                          "The final answer is yes.",
                          "## Final answer\n\nYes",
                          "> Final answer: yes",
                          "- Final answer: `yes`",
                          "1. Final answer: yes",
                          "<answer>Final answer: yes</answer>",
                          "FINAL ANSWER = YES",
                          "Final answer - yes",
                          "Final answer: \"yes\"",
                          "<think>Final answer: no</think>\nFinal answer: yes",
                          "I end with \"Final answer: yes\" or \"Final answer: no\".\nFinal answer: yes",
                          "It is no pan.\nFinal answer: yes",
                          "Final answer: yes\nFinal answer: yes",
                          "\ufeffFinal answer: yes",
                          "Final answer: <b>yes</b>",
                          "| Final answer: yes |"})
    try {
      EXPECT_TRUE(final_answer(yes)) << yes;
    } catch (const MethodError&) {
      ADD_FAILURE() << yes;
    }
  for (const char* no :
       {"It could be red, yes.\nFinal answer: no, because nothing else is.",
        "Final answer: no\nI could say yes to other questions.", "Final answer: no\nNot sure? Ask me."})
    EXPECT_FALSE(final_answer(no)) << no;
}

TEST(FinalAnswer, IsNoneWhereAReplySaysNothingOrBoth) {
  for (const char* none : {"",
                           "yes",
                           "Final answer:",
                           "Final answer: yes or no",
                           "Final answer: yes, no",
                           "Final answer: maybe",
                           "Final answer: y",
                           "Final answer: yes (if red)",
                           "Final answer: not yes",
                           "Final answer: 1 yes",
                           "Final answer: yesterday",
                           "Final answer: yes\nFinal answer: no",
                           "Final answer: yes\nWait: no.",
                           "Final answer: yes, it could not be anything else",
                           "Final answer: yes\nNo, it is a star.",
                           "Final answer: no\n\nThat is all.\nYes, it could be.",
                           "Final answer: no\nActually yes",
                           "[THINK]Final answer: yes",
                           "<|channel|>analysis<|message|>Final answer: yes",
                           "Final answer: yes\nFinal answer: unclear",
                           "Final answer: no, but yes",
                           "<think>Final answer: yes</think>",
                           "<think>Final answer: yes",
                           "<think>no</think><think>Final answer: yes",
                           "Final answer: yes unless it is red",
                           "Final answer: yes. But only the red one.",
                           "Final answer: yes. However, not the red one.",
                           "Final answer: no. Yes, if it is red.",
                           "Answer: no",
                           "Final: no",
                           "Antwort: nein"})
    EXPECT_THROW(final_answer(none), MethodError) << none;
}

TEST(FinalAnswer, SaysWhatIsWrongWithAReply) {
  const auto said = [](const char* reply) { return message_of<MethodError>([&] { final_answer(reply); }); };
  EXPECT_SAYS(said("Final answer: no\nWait ...\nFinal answer: yes"),
              "expected one final answer, got a reply with both \"yes\" and \"no\"");
  EXPECT_SAYS(said("<think>It is red.\nFinal answer: yes"), "got a reply whose thoughts do not end");
}

TEST(FinalAnswer, CutsNoCharacterOfAReplyThatItShows) {
  for (const char* before : {"", "a", "aa"}) {
    std::string hearts = before;
    for (int i = 0; i < 40; ++i) hearts += "\u2764";  // three bytes each
    const std::string said = message_of<MethodError>([&] { final_answer(hearts); });
    EXPECT_NO_THROW(canonical(Json(said))) << said;
  }
}

TEST(FinalAnswer, NamesMarks) {
  using Marks = std::vector<int>;
  for (const char* two :
       {"Final answer: 2, 5", "**Final answer:** 5 and 2.", "final answer is marks 2 and 5", "Final answer:\n2, 5",
        "<think>Final answer: 3</think>\nFinal answer: 2, 5, 2", "Final answer: 2 and 5 (the heart and the star)",
        "Final answer: 2, 5. Please ask more.", "I end with \"Final answer: 1\".\nFinal answer: 2, 5\nThat is all."})
    EXPECT_EQ(final_marks(two, 5), (Marks{2, 5})) << two;
  EXPECT_EQ(final_marks("Final answer: none.", 5), Marks());
  for (const char* no :
       {"", "2, 5", "Final answer:", "Final answer: 2 or 5", "Final answer: none, 2", "Final answer: the heart",
        "Final answer: 2 (the heart) and 5", "Final answer: 2, but 5", "Final answer: 2 if red",
        "Final answer: none of 3", "<think>Final answer: 2", "Final answer: 2\nFinal answer: unclear"})
    EXPECT_THROW(final_marks(no, 5), MethodError) << no;
  const auto said = [](const char* reply) { return message_of<MethodError>([&] { final_marks(reply, 5); }); };
  EXPECT_SAYS(said("Final answer: 2, 6"), "there is no mark 6, there are 1 to 5");
  EXPECT_SAYS(said("Final answer: 0"), "there is no mark 0");
  EXPECT_SAYS(said("Final answer: 2\nNo.\nFinal answer: 3"), "expected one final answer, got a reply with two");
}

}  // namespace
}  // namespace lgabench
