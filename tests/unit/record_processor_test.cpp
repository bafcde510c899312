// The processor that a record names, and who owes whom the same bits.
#include <gtest/gtest.h>

#include <lgabench/record/processor.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

Processor processor_of(const Json& machine) { return read_processor(JsonReader(machine, "run.json", "/machine")); }

TEST(Processors, NameAndInstructionsAreReadApartOrJoined) {
  const auto text = [](const Json& machine) { return to_string(processor_of(machine)); };
  EXPECT_EQ(text({{"processor", "AMD EPYC"}, {"instructions", "AVX2"}}), "AMD EPYC with AVX2");
  EXPECT_EQ(text({{"processor", "AMD EPYC"}, {"instructions", "without FMA"}}), "AMD EPYC without FMA");
  EXPECT_EQ(text({{"processor", "AMD EPYC"}}), "AMD EPYC, instructions not recorded");
  for (const char* instructions : {"AVX-512", "AVX2"}) {
    const Processor joined = processor_of({{"processor", fmt::format("AMD EPYC with {}", instructions)}});
    EXPECT_EQ(joined.name, "AMD EPYC");
    EXPECT_EQ(joined.instructions, instructions);
  }
  EXPECT_EQ(processor_of({{"processor", "with AVX2"}}).instructions, "") << "a name";
  EXPECT_SAYS(message_of<InputError>([&] {
                text({{"processor", "AMD EPYC"}, {"instructions", "SSE9"}});
              }),
              "run.json: /machine/instructions: expected AVX-512, AVX2 or without FMA");
  const Processor here = this_processor();
  EXPECT_EQ(to_string(processor_of({{"processor", here.name}, {"instructions", here.instructions}})), to_string(here));
  EXPECT_NE(here.instructions, "");
}

TEST(Processors, OweTheSameBits) {
  const Processor wide{"AMD EPYC", "AVX-512"}, narrow{"AMD EPYC", "AVX2"}, intel{"Xeon", "AVX-512"},
      old{"Atom", "without FMA"}, unknown{"AMD EPYC"};
  for (const Processor& one : {wide, narrow, intel, old})
    for (const bool own : {true, false}) EXPECT_TRUE(owe_same_bits(one, one, own)) << to_string(one);
  for (const auto& [one, other] : {std::pair(wide, narrow), {wide, intel}, {narrow, intel}}) {
    EXPECT_TRUE(owe_same_bits(one, other, true)) << to_string(one) << " and " << to_string(other);
    EXPECT_FALSE(owe_same_bits(one, other, false)) << to_string(one) << " and " << to_string(other);
  }
  for (const Processor& one : {wide, narrow, intel}) {
    EXPECT_FALSE(owe_same_bits(one, old, true));
    EXPECT_FALSE(owe_same_bits(old, one, true));
    EXPECT_FALSE(owe_same_bits(unknown, one, true)) << "not recorded";
    EXPECT_FALSE(owe_same_bits(one, unknown, true)) << "not recorded";
  }
  EXPECT_FALSE(owe_same_bits(unknown, unknown, true)) << "not recorded";
  EXPECT_FALSE(owe_same_bits({"Atom", "without FMA"}, {"Other", "without FMA"}, true));
}

}  // namespace
}  // namespace lgabench
