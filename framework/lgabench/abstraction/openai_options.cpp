#include <lgabench/abstraction/openai_options.hpp>

#include <cstdlib>

namespace lgabench {

OpenAiOptions openai_from_environment() {
  const auto named = [](const char* name, const char* usual) {
    const char* value = std::getenv(name);
    return std::string(value && *value ? value : usual);
  };
  OpenAiOptions options;
  options.base_url = named("OPENAI_BASE_URL", openai_server);
  options.api_key = named("OPENAI_API_KEY", "");
  options.ca_file = named("SSL_CERT_FILE", "");
  while (!options.base_url.empty() && options.base_url.back() == '/') options.base_url.pop_back();
  return options;
}

std::string provider(const OpenAiOptions& options) {
  std::string url = options.base_url;
  const std::size_t scheme = url.find("://"), begin = scheme == std::string::npos ? 0 : scheme + 3;
  const std::size_t path = url.find('/', begin), at = url.rfind('@', path);
  if (at != std::string::npos && at >= begin) url.erase(begin, at + 1 - begin);
  return url;
}

}  // namespace lgabench
