// What a run leaves on disk, word by word: outcomes as letters, whose answers, whose scenes; temporary directories.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <tuple>

#include <lgabench/core/hash.hpp>
#include <lgabench/core/scratch.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/record/answer_source.hpp>
#include <lgabench/record/cell_status.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/record/outcome.hpp>
#include <lgabench/record/run_record.hpp>
#include <lgabench/record/test_scenes.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

const std::vector<std::string> words{"method_error", "missed_object", "dropped"};

std::vector<Episode> every_ending() {
  std::vector<Episode> all(1);
  for (const std::string& failure : words)
    for (const char* attribution : {"", "abstraction", "policy", "perception"}) {
      all.emplace_back().failure = failure;
      all.back().attribution = attribution;
    }
  return all;
}

TEST(Outcome, APagesTwoLettersSayAll) {
  for (const Episode& episode : every_ending()) {
    const auto read = read_outcome(outcome_letter(episode, words), attribution_letter(episode), words);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->failure, episode.failure);
    EXPECT_EQ(read->attribution, episode.attribution);
  }
}

TEST(Outcome, AnEntrysLetterSaysTheFailureAndTheAbstraction) {
  for (const Episode& episode : every_ending()) {
    const char letter = entry_letter(episode, words);
    const auto read = read_entry_letter(letter, words);
    ASSERT_TRUE(read) << letter;
    EXPECT_EQ(read->failure, episode.failure);
    EXPECT_EQ(read->attribution, episode.attribution == "abstraction" ? "abstraction" : "");
    EXPECT_EQ(is_success(letter), episode.success());
  }
  EXPECT_EQ(successes(".aB..!"), 3);
}

TEST(Outcome, OtherLettersSayNothing) {
  for (const char letter : {'d', 'D', 'z', '!', '1', ' ', '\0'})
    EXPECT_FALSE(read_entry_letter(letter, words)) << letter;
  EXPECT_FALSE(read_outcome('a', 'x', words));
  EXPECT_FALSE(read_outcome('.', 'p', words)) << "a success is attributed to nothing";
}

TEST(CellStatus, IsReadAsItWasWritten) {
  const Scratch cell("status");
  CellStatus ok, failed;
  ok.method_error = "plugin mine: threw";
  ok.files = {{"cell.json", sha256("")}};
  failed.failed = true;
  failed.reason = "signal 9 (Killed) in phase learn";
  failed.fault = "host";
  failed.signal = 9;
  failed.log_tail = {"epoch 1", "epoch 2"};
  for (CellStatus* status : {&ok, &failed}) {
    status->build = {{"method", sha256("method")}};
    write_cell_status(cell.path, *status);
    const CellStatus read = read_cell_status(cell.path);
    EXPECT_EQ(std::tie(read.failed, read.reason, read.fault, read.signal, read.log_tail, read.method_error, read.build,
                       read.files),
              std::tie(status->failed, status->reason, status->fault, status->signal, status->log_tail,
                       status->method_error, status->build, status->files));
  }
}

TEST(AnswerSource, EachWordIsOneValue) {
  const auto is = [](const char* word, std::size_t which) {
    EXPECT_EQ(read_answer_source(word).index(), which) << word;
    EXPECT_EQ(to_string(read_answer_source(word)), word);
  };
  for (const char* word : {"recorded", "claude", "gpt4_study", "cassette:", "openai:"}) is(word, 0);
  is("cassette:tape.jsonl", 1);
  is("file:mine.json", 2);
  for (const char* word : {"openai", "openai:a model:7b"}) is(word, 3);
  is("none", 4);
  EXPECT_EQ(to_string(read_answer_source("mine.json")), "file:mine.json");
  EXPECT_EQ(std::get<CassetteAnswers>(read_answer_source("cassette:a:b")).file, "a:b");
  EXPECT_EQ(to_string(AnswerSource()), "recorded");
}

TEST(AnswerSource, WordsOnTheCommandLine) {
  for (const std::string& word : answer_words(true)) EXPECT_EQ(answers_complaint(word, true), "");
  EXPECT_EQ(answers_complaint("cassette:tape", false), "");
  EXPECT_EQ(answers_complaint("my/answers.json", false), "");
  EXPECT_SAYS(answers_complaint("none", false), "expected recorded, ");
  EXPECT_SAYS(answers_complaint("openai:m", true), "openai, none, cassette:FILE or FILE.json, got openai:m");
}

TEST(TestScenes, SetsOfTrainingSeeds) {
  EXPECT_EQ(scene_sets(TestScenes::per_seed, {3, 5}), (std::vector<std::uint64_t>{3, 5}));
  EXPECT_EQ(scene_sets(TestScenes::shared, {3, 5}), std::vector<std::uint64_t>{0});
  EXPECT_EQ(scene_set(TestScenes::shared, 5), 0u);
  for (const TestScenes scenes : {TestScenes::shared, TestScenes::per_seed})
    EXPECT_EQ(read_test_scenes(JsonReader(Json(scenes), "file")), scenes);
}

TEST(RunRecord, VersionsThatComputeTheSameCells) {
  EXPECT_TRUE(same_cells("0.3.0", "0.3.7"));
  EXPECT_TRUE(same_cells("0.4.0", "0.5.1"));
  EXPECT_FALSE(same_cells("0.4.0", "0.3.0"));
  EXPECT_FALSE(same_cells("0.6.0", "0.5.0"));
}

TEST(Layout, AReportsFilesAreAmongARuns) {
  for (const auto& list : {std::vector<std::string>(document_entries.begin(), document_entries.end()),
                           std::vector<std::string>(run_directories.begin(), run_directories.end())})
    for (const std::string& name : list) EXPECT_EQ(std::count(run_entries.begin(), run_entries.end(), name), 1) << name;
}

TEST(Scratch, WhatAKilledProcessLeftGoesWithTheNextOne) {
  const TemporaryDirectory temporary;
  ::setenv("TMPDIR", temporary.path.c_str(), 1);
  const auto directories = [&] {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(temporary.path)) all.push_back(entry.path());
    return all;
  };
  if (const pid_t child = ::fork(); child == 0) {
    const Scratch abandoned("test");
    write_file(abandoned.path / "deep/file", "bytes");
    ::_exit(0);  // as by kill -9: no destructor runs
  } else {
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
  }
  ASSERT_EQ(directories().size(), 1u);
  const fs::path others = temporary.path / "lgabench-test-of.another";
  fs::create_directory(others);
  {
    const Scratch first("test");
    EXPECT_EQ(directories().size(), 2u) << "the abandoned one is gone";
    const Scratch second("test");
    EXPECT_TRUE(fs::exists(first.path)) << "one that is in use stays";
    EXPECT_NE(first.path, second.path);
  }
  EXPECT_EQ(directories(), std::vector<fs::path>{others});
  ::unsetenv("TMPDIR");
}

// Each sees those of the others while they are made.
TEST(Scratch, ManyAtOnceKeepTheirDirectories) {
  const TemporaryDirectory temporary;
  ::setenv("TMPDIR", temporary.path.c_str(), 1);
  std::atomic<int> kept = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 8; ++thread)
    threads.emplace_back([&kept] {
      for (int i = 0; i < 200; ++i) try {
          const Scratch scratch("test");
          kept += fs::exists(scratch.path);
        } catch (const InputError&) {
        }
    });
  for (std::thread& thread : threads) thread.join();
  ::unsetenv("TMPDIR");
  EXPECT_EQ(kept, 1600);
}

}  // namespace
}  // namespace lgabench
