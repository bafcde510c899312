// The study's pages over HTTP. It keeps no address, no browser's name, and sets no cookie.
#pragma once
#include <memory>
#include <string>

#include <lgabench/study/study.hpp>

namespace lgabench::study {

/// A contact sheet of a feature's words (lgabench render --gallery).
struct PictureSheet {
  std::string png;
  Json cells;  // {"names", "tile", "step", "across"}
};

/// What the pages are made of, in memory.
struct Site {
  std::string page, style, script;
  PictureSheet object_types, textures,
      pairs;  // pairs: those that the protocol asks about, "TYPE, TEXTURE"; may be none
};
/// The pages' files from the data directory's study/, and pictures drawn by lgabench-worker. @throws InputError where
/// either is missing.
Site load_site(const Protocol& protocol);

struct Listening {
  std::string address = "127.0.0.1";
  int port = 0;              // 0: any that is free
  std::string host;          // the name that a proxy passes on; "": only this machine's own names are answered to
  std::string invitation{};  // what whoever begins must bring along (/?invitation=...); "": nothing
  int begins_a_minute = 0;   // at most so many people; 0: any number, as of simulated ones
};

class Server {
 public:
  /// Binds. The study must outlive it. @throws InputError where the address cannot be had.
  Server(Study& study, Site site, Listening where);
  ~Server();

  int port() const;
  /// Serves until stop(), which any thread may call.
  void run();
  void stop();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lgabench::study
