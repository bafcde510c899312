// Names that a person's secret id gives rise to. The id itself is in the page's address and in a file's name, no more.
#pragma once
#include <string>

namespace lgabench::study {

/// 128 random bits as 32 hexadecimal digits.
std::string random_id();
/// Whether a text from outside has that form.
bool is_id(const std::string& text);
/// What the person who has that id withdraws with: "7KQ2-XH4D-..."; it does not tell the id. Derived, so that it is
/// stored nowhere.
std::string withdrawal_code(const std::string& id);
/// A code as a person may type it: upper case, without spaces and dashes.
std::string plain_code(const std::string& typed);

}  // namespace lgabench::study
