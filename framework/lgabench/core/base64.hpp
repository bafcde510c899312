// Bytes as text.
#pragma once
#include <string>
#include <string_view>

namespace lgabench {

/// Base64 with padding, without line breaks (RFC 4648; OpenSSL's libcrypto).
std::string base64(std::string_view bytes);

}  // namespace lgabench
