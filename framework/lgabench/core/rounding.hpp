// Numbers as people read them: one rounding for every table, figure and message.
#pragma once
#include <string>

namespace lgabench {

/// The number with so many decimals, halves away from zero, never "-0.00". A half stays one whichever way it was
/// computed: 29/40 and the mean of .70 and .75 both are "0.73".
std::string fixed(double value, int digits = 2);
/// The number with its sign: "+0.10", "-0.03"; "0.00" for none.
std::string signed_text(double value, int digits = 2);

}  // namespace lgabench
