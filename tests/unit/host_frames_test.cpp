#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include <lgabench/host/messages.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

void wait_for(int fd, short events) {
  pollfd watched{fd, events, 0};
  ::poll(&watched, 1, 1000);
}

// Two ends of a socket: one speaks frames, the other is written to by hand.
struct Ends {
  Ends() {
    int ends[2];
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    raw = Descriptor(ends[1]);
    channel = std::make_unique<Channel>(Descriptor(ends[0]), [fd = ends[0]](short events) { wait_for(fd, events); });
  }
  void write(const std::string& bytes) const { EXPECT_EQ(::write(raw.fd, bytes.data(), bytes.size()), bytes.size()); }
  std::string refusal() {
    return message_of<Malformed>([this] { channel->receive(); });
  }

  std::unique_ptr<Channel> channel;
  Descriptor raw;
};

std::string number(std::uint32_t value) { return {reinterpret_cast<const char*>(&value), sizeof value}; }

// A frame as bytes, by way of a channel.
std::string bytes_of(const Json& header, const std::string& payload = {}) {
  Ends ends;
  ends.channel->send(header, payload);
  std::string bytes(1 << 16, 0);
  bytes.resize(static_cast<std::size_t>(::read(ends.raw.fd, bytes.data(), bytes.size())));
  return bytes;
}

TEST(Frames, arrive_as_they_were_sent) {
  Ends ends;
  const std::string bytes = bytes_of({{"type", "needs"}, {"x", {1, 2.5, "ü"}}}, std::string("\0\1", 2));
  ends.write(bytes.substr(0, 7));
  ends.write(bytes.substr(7) + bytes);
  for (int i = 0; i < 2; ++i) {
    const std::optional<Frame> frame = ends.channel->receive();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->type(), "needs");
    EXPECT_EQ(frame->header["x"], Json({1, 2.5, "ü"}));
    EXPECT_EQ(frame->payload, std::string("\0\1", 2));
  }
  ends.raw.close();
  EXPECT_FALSE(ends.channel->receive());
}

TEST(Frames, whose_peer_goes_in_the_middle_are_none) {
  Ends ends;
  const std::string bytes = bytes_of({{"type", "needs"}});
  ends.write(bytes.substr(0, bytes.size() - 1));
  ends.raw.close();
  EXPECT_FALSE(ends.channel->receive());
}

TEST(Frames, that_are_malformed_are_refused_with_the_reason) {
  const std::string good = bytes_of({{"type", "needs"}}, "12345678");
  const auto refusal_of = [](const std::string& bytes) {
    Ends ends;
    ends.write(bytes);
    ends.raw.close();  // ends a reader that took it
    return ends.refusal();
  };
  EXPECT_SAYS(refusal_of("{\"phase\": \"the fixture's own\"}\n"), "its first bytes are not those of a frame");
  EXPECT_SAYS(refusal_of("LGA1" + number(9 << 20) + number(0) + number(0)),
              "a header of 9437184 bytes, at most 8388608");
  EXPECT_SAYS(refusal_of("LGA1" + number(2) + number((1 << 20) + 1) + number(0)),
              "a payload of 1048577 bytes, at most 1048576");
  std::string other = good;
  other.back() = 'x';
  EXPECT_SAYS(refusal_of(other), "checksum");
  for (const auto& header : {Json::array(), Json(3), Json::object(), Json({{"type", 3}})})
    EXPECT_SAYS(refusal_of(bytes_of(header)), "\"type\"");
  Json deep = {{"type", "needs"}};
  for (int i = 0; i < 120; ++i) deep = {{"type", "needs"}, {"x", deep}};
  EXPECT_SAYS(refusal_of(bytes_of(deep)), "100 levels");
}

TEST(Frames, over_the_limits_are_not_sent) {
  Ends ends;
  EXPECT_SAYS(message_of<MethodError>([&] {
                ends.channel->send({{"type", "a"}}, std::string(2 << 20, 'x'));
              }),
              "over the limits");
}

TEST(Frames, carry_a_file_that_nobody_can_write_to) {
  Ends ends;
  host::SharedMemory memory(4096);
  memory.data()[7] = 42;
  Channel sender(std::move(ends.raw), [](short) {});
  sender.send({{"type", "hello"}}, {}, &memory.file());
  const std::optional<Frame> frame = ends.channel->receive();
  ASSERT_TRUE(frame);
  const host::SharedMemory read(frame->file, 4096);
  EXPECT_EQ(read.data()[7], 42);
  memory.data()[7] = 43;
  EXPECT_EQ(read.data()[7], 43);
  EXPECT_EQ(::mmap(nullptr, 4096, PROT_WRITE, MAP_SHARED, frame->file.fd, 0), MAP_FAILED);
  EXPECT_LT(::pwrite(frame->file.fd, "x", 1, 0), 0);
  EXPECT_SAYS(message_of<InputError>([&] { host::SharedMemory(frame->file, 4097); }), "4097");
}

std::size_t open_descriptors() {
  const fs::directory_iterator all("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

TEST(Frames, leave_no_descriptor_behind_whatever_a_peer_attaches) {
  Ends ends;
  std::string bytes = bytes_of({{"type", "needs"}});
  const std::size_t before = open_descriptors();
  alignas(cmsghdr) char control[CMSG_SPACE(2 * sizeof(int))] = {};
  iovec part{bytes.data(), bytes.size()};
  msghdr message{};
  message.msg_iov = &part, message.msg_iovlen = 1;
  message.msg_control = control, message.msg_controllen = sizeof control;
  cmsghdr* rights = CMSG_FIRSTHDR(&message);
  rights->cmsg_level = SOL_SOCKET, rights->cmsg_type = SCM_RIGHTS;
  rights->cmsg_len = CMSG_LEN(2 * sizeof(int));
  const int two[2] = {ends.raw.fd, ends.raw.fd};
  std::memcpy(CMSG_DATA(rights), two, sizeof two);
  ASSERT_EQ(::sendmsg(ends.raw.fd, &message, 0), static_cast<ssize_t>(bytes.size()));
  EXPECT_TRUE(ends.channel->receive());
  EXPECT_EQ(open_descriptors(), before);
}

TEST(Messages, actions_keep_what_is_no_number) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  const Action action{.1, nan, infinity, -0.0, 1e-320};
  const Action back = host::read_action(host::to_bytes(action), 5);
  EXPECT_TRUE(std::isnan(back[1]));
  EXPECT_EQ(back[2], infinity);
  EXPECT_TRUE(std::signbit(back[3]));
  EXPECT_EQ(host::to_bytes(back), host::to_bytes(action));
  EXPECT_SAYS(message_of<InputError>([] { host::read_action("short", 12); }), "expected 96 bytes, 12 doubles");
}

TEST(Messages, a_log_arrives_as_it_was_reported) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Frame frame = host::log_frame({{10, 40, .1}, {20, 80, nan}});
  const auto read = host::read_log(frame);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].epochs, 10);
  EXPECT_EQ(read[0].steps, 40);
  EXPECT_EQ(read[0].loss, .1);
  EXPECT_EQ(read[1].epochs, 20);
  EXPECT_TRUE(std::isnan(read[1].loss));

  const auto refusal = [](const Json& header, const std::string& payload) {
    return message_of<InputError>([&] { host::read_log({header, payload}); });
  };
  EXPECT_SAYS(refusal({{"epochs", {1, 2}}, {"steps", {1}}}, frame.payload), "/steps: expected as many as epochs");
  EXPECT_SAYS(refusal({{"epochs", {1}}, {"steps", {1}}}, frame.payload), "a double for each epoch");
  EXPECT_SAYS(refusal({{"epochs", {-1}}, {"steps", {1}}}, std::string(8, 0)), "/epochs/0");

  const Frame curves = host::log_frame({{1, 4, .1, {{"validation", .2}, {"picked", nan}}}, {2, 8, .05}});
  const auto with = host::read_log(curves);
  ASSERT_EQ(with.size(), 2u);
  ASSERT_EQ(with[0].curves.size(), 2u);
  EXPECT_EQ(with[0].curves[0], std::pair(std::string("validation"), .2));
  EXPECT_TRUE(std::isnan(with[0].curves[1].second));
  EXPECT_EQ(with[1].loss, .05);
  EXPECT_TRUE(with[1].curves.empty());
  EXPECT_SAYS(refusal({{"epochs", {1}}, {"steps", {1}}, {"curves", {{"a"}, {"b"}}}}, std::string(24, 0)),
              "/curves: expected as many as epochs");
  EXPECT_SAYS(refusal({{"epochs", {1}}, {"steps", {1}}, {"curves", {{"a"}}}}, std::string(8, 0)), "and curve");
}

// No environment's that there is.
const host::Layout layout{{30, 40}, {{{"u", "", 0, 1}, {"angle", "", -1, 1}}, {}, {}}};

Observation observation(std::uint8_t colour) {
  Observation o;
  o.size = layout.picture;
  o.rgb.assign(3 * o.size.pixels(), colour);
  o.ids.assign(o.size.pixels(), 0);
  o.ids[5] = 9;
  o.instances = {{9, "heart", "red", 1}, {3, "pallet", "plain", 0}};
  return o;
}

Observation shaded(std::uint8_t seed) {
  Observation seen = observation(seed);
  for (std::size_t i = 0; i < seen.ids.size(); ++i) seen.shadows.push_back(static_cast<std::uint16_t>(i * 7919 + seed));
  return seen;
}

TEST(Messages, demonstrations_arrive_as_they_were_packed) {
  Selection selection;
  selection.target = {{"heart"}, {"red"}};
  selection.second = SecondSet{{{}, {"blue"}}, "avoid"};
  selection.provenance = Provenance::cassette;
  selection.source = "a model";
  const std::vector<Demonstration> given{
      {{"Bring me the heart.", selection}, {{observation(1), {.3, -1}}, {observation(2), {0, 0}}}},
      {{"none", {}}, {}},
      {{"other", {}}, {{observation(3), {1, .5}}}}};
  const host::DemonstrationFile packed = host::pack(layout, given);
  const Json header = Json::parse(packed.header.dump());
  const auto read = host::unpack(layout, JsonReader(header, "learn"), packed.file);
  ASSERT_EQ(read.size(), given.size());
  for (std::size_t d = 0; d < given.size(); ++d) {
    EXPECT_EQ(read[d].instruction.utterance, given[d].instruction.utterance);
    EXPECT_EQ(host::selection_for_method(read[d].instruction.selection),
              host::selection_for_method(given[d].instruction.selection));
    ASSERT_EQ(read[d].steps.size(), given[d].steps.size());
    for (std::size_t s = 0; s < given[d].steps.size(); ++s) {
      const Step &a = read[d].steps[s], &b = given[d].steps[s];
      EXPECT_EQ(a.observation.rgb, b.observation.rgb);
      EXPECT_EQ(a.observation.ids, b.observation.ids);
      EXPECT_EQ(host::instances_json(a.observation), host::instances_json(b.observation));
      EXPECT_EQ(host::to_bytes(a.label), host::to_bytes(b.label));
    }
  }
  Json beyond = header;
  beyond["arrays"]["ids"]["offset"] = packed.size;
  EXPECT_SAYS(message_of<InputError>([&] { host::unpack(layout, JsonReader(beyond, "learn"), packed.file); }),
              "an array within the file");
}

TEST(Messages, shadows_arrive_where_every_step_has_them) {
  const auto arrive = [](const std::vector<Demonstration>& given) {
    const host::DemonstrationFile packed = host::pack(layout, given);
    return host::unpack(layout, JsonReader(packed.header, "learn"), packed.file);
  };
  const Step one{shaded(1), {.3, -1}}, other{shaded(2), {0, 0}}, plain{observation(3), {0, 0}};
  const auto all = arrive({{{"a", {}}, {one}}, {{"b", {}}, {other}}});
  EXPECT_EQ(all[0].steps[0].observation.shadows, one.observation.shadows);
  EXPECT_EQ(all[1].steps[0].observation.shadows, other.observation.shadows);
  EXPECT_NE(one.observation.shadows, other.observation.shadows);
  for (const Demonstration& d : arrive({{{"a", {}}, {one, plain}}}))
    EXPECT_TRUE(d.steps[0].observation.shadows.empty());
  host::DemonstrationFile packed = host::pack(layout, {{{"a", {}}, {one}}});
  packed.header["arrays"]["shadows"]["shape"] = {1, 1, 1};
  EXPECT_SAYS(message_of<InputError>([&] { host::unpack(layout, JsonReader(packed.header, "learn"), packed.file); }),
              "an array of the shape of ids");
}

TEST(Messages, an_observation_arrives_through_shared_memory) {
  host::SharedMemory memory(host::observation_bytes(layout.picture));
  host::write(observation(7), memory);
  const Json instances = host::instances_json(observation(7));
  Observation read;
  host::read_observation(memory, layout.picture, JsonReader(instances, "act"), false, read);
  EXPECT_EQ(read.size, layout.picture);
  EXPECT_EQ(read.rgb, observation(7).rgb);
  EXPECT_EQ(read.ids, observation(7).ids);
  EXPECT_EQ(host::instances_json(read), instances);
  EXPECT_TRUE(read.shadows.empty());
  host::write(shaded(7), memory);
  host::read_observation(memory, layout.picture, JsonReader(instances, "act"), true, read);
  EXPECT_EQ(read.shadows, shaded(7).shadows);
  EXPECT_EQ(read.ids, observation(7).ids);
  Observation larger = observation(7);
  larger.size = {31, 40};
  EXPECT_SAYS(message_of<Error>([&] { host::write(larger, memory); }), "got 31 x 40");
}

TEST(Messages, what_is_perceived_arrives_with_its_pixels_counted) {
  Observation sent = observation(7);
  sent.instances.front().pixels = -5;
  const Frame ids = host::ids_frame(sent), perceived = host::perceived_frame(sent);
  const Observation read = host::read_perceived(ids, perceived, layout.picture);
  EXPECT_EQ(read.rgb, sent.rgb);
  EXPECT_EQ(read.ids, sent.ids);
  ASSERT_EQ(read.instances.size(), sent.instances.size());
  EXPECT_EQ(read.instances.front().object_type, sent.instances.front().object_type);
  EXPECT_EQ(read.instances.front().pixels, std::count(sent.ids.begin(), sent.ids.end(), sent.instances.front().id));
  const auto refusal = [](const Frame& some_ids, const Frame& some_perceived) {
    return message_of<InputError>([&] { host::read_perceived(some_ids, some_perceived, layout.picture); });
  };
  EXPECT_SAYS(refusal({ids.header, "short"}, {perceived.header, perceived.payload}), "a byte for each pixel");
  EXPECT_SAYS(refusal({ids.header, ids.payload}, {perceived.header, "short"}), "3 bytes for each pixel");
  Json none = perceived.header;
  none["instances"][0]["id"] = 0;
  EXPECT_SAYS(refusal({ids.header, ids.payload}, {none, perceived.payload}), "/instances/0/id");
}

TEST(Messages, a_layout_arrives_as_it_was_said) {
  const Json json = host::to_json(layout);
  EXPECT_EQ(host::to_json(host::read_layout({json, "hello"})), json);
  Json none = json;
  none["observation"]["rows"] = 0;
  EXPECT_SAYS(message_of<InputError>([&] { host::read_layout({none, "hello"}); }), "/observation/rows");
}

}  // namespace
}  // namespace lgabench
