// Policies that played the same scenes, paired episode by episode.
#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

#include <lgabench/report/results.hpp>
#include <lgabench/report/statistics.hpp>

namespace lgabench::report {

/// Two policies on the scenes of one arm.
struct PolicyPair {
  int episodes = 0, won_first = 0, won_second = 0;
  int only_first = 0, only_second = 0;  // scenes that one alone won
  bool same_actions = true;             // in every scene the same, bit for bit

  double difference() const { return static_cast<double>(only_second - only_first) / episodes; }
};

/// Why the two did not play the same scenes with the same commands in the arm, in one line; empty if they did. @pre
/// both cells finished and have the arm
std::string why_unpaired(const CellResult& first, const CellResult& second, const std::string& arm);

/// @throws InputError, in one line, where why_unpaired() has a reason. @pre as there
PolicyPair pair_policies(const CellResult& first, const CellResult& second, const std::string& arm);

/// Pairs of policies of one row of a table: scenarios, and within each training seeds, or participants where a row has
/// several.
class PairedRow {
 public:
  void add(const std::string& scenario, const PolicyPair& pair, const std::string& participant = "");

  const PolicyPair& total() const { return total_; }  // of all pairs
  int scenarios() const { return static_cast<int>(differences_.size()); }
  int policies() const { return policies_; }
  int participants() const { return static_cast<int>(participants_.size()); }
  /// Mean over scenarios of the mean over training seeds (participants) of the policies' success.
  double first_success() const { return cluster_mean(clusters(first_)); }
  double second_success() const { return cluster_mean(clusters(second_)); }
  /// paired_change of second minus first, with the episodes of one participant on the mean, as the other row's policy
  /// may be the same in all their pairs; `name` seeds its random stream. @pre not empty
  Change change(const std::string& name) const;

 private:
  static std::vector<Cluster> clusters(const std::vector<PolicyValues>& scenarios);

  std::map<std::string, std::size_t> index_;  // of each scenario in what follows
  std::vector<PolicyValues> first_, second_, differences_;
  std::set<std::string> participants_;
  int policies_ = 0;
  PolicyPair total_;
};

/// "+0.10 [-0.03, +0.23]"
std::string change_text(const Change& change);
/// "p = 0.013", "p < 0.001"
std::string p_text(double p);

}  // namespace lgabench::report
