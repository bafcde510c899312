// The board's files against their schemas in docs/formats.
#include <lgabench/leaderboard/fields.hpp>

#include "../../described.hpp"

namespace lgabench::leaderboard {
namespace {

TEST(Fields, WriteTheSchemasOfTheBoard) {
  expect_schema("cells", schema_of<PlayedCell>());
  expect_schema("entry", schema_of<Identity>(), "/properties/identity");
  expect_schema("entry", schema_of<Setting>(), "/properties/preset");
  expect_schema("scenes", schema_of<EntryScene>(), "/definitions/scene");
}

}  // namespace
}  // namespace lgabench::leaderboard
