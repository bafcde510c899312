// What several tests need.
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include <lgabench/core/environments.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scratch.hpp>

namespace lgabench {

/// what() of the Expected that `call` throws. Anything else, or nothing, fails the test.
template <class Expected, class Call>
std::string message_of(Call&& call) {
  try {
    call();
  } catch (const Expected& e) {
    return e.what();
  } catch (const std::exception& e) {
    ADD_FAILURE() << "another exception: " << e.what();
    return {};
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

inline testing::AssertionResult says(const std::string& text, const std::string& part) {
  const bool found = text.find(part) != std::string::npos;
  return (found ? testing::AssertionSuccess() : testing::AssertionFailure()) << "\"" << part << "\" in: " << text;
}

// Macros, so that a failure names the line of the test.
#define EXPECT_SAYS(text, part) EXPECT_TRUE(says(text, part))
#define EXPECT_SILENT(text, part) EXPECT_FALSE(says(text, part))

/// A command of that task, with the second set that the task has.
inline Command command_of(const std::string& task, const std::string& utterance) {
  return {utterance, task, find_task(find_environment("tabletop"), task).second};
}

/// A new directory, removed at the end.
struct TemporaryDirectory : Scratch {
  TemporaryDirectory() : Scratch("test") {}
};

}  // namespace lgabench
