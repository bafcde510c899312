// What must agree for two libraries to share C++ objects, as text that the preprocessor builds: the plugin's compiler
// writes the plugin's, the framework's compiler writes the host's. A macro, so that no two libraries share one symbol.
#pragma once
#include <version>  // defines the standard library's own macros, also before C++20

#include <lgabench/core/version.hpp>

#define LGABENCH_TEXT_(x) #x
#define LGABENCH_TEXT(x) LGABENCH_TEXT_(x)

#if defined(__x86_64__)
#define LGABENCH_ARCHITECTURE "x86_64"
#elif defined(__aarch64__)
#define LGABENCH_ARCHITECTURE "aarch64"
#else
#error "lgabench plugins are known to work on x86_64 and aarch64 only"
#endif

#if defined(__GLIBCXX__)
#define LGABENCH_STANDARD_LIBRARY "libstdc++ " LGABENCH_TEXT(_GLIBCXX_RELEASE)
#elif defined(_LIBCPP_VERSION)
#define LGABENCH_STANDARD_LIBRARY "libc++ " LGABENCH_TEXT(_LIBCPP_ABI_VERSION)
#else
#error "unknown C++ standard library"
#endif

#if defined(__GLIBCXX__) && _GLIBCXX_USE_CXX11_ABI
#define LGABENCH_STRINGS "cxx11"
#elif defined(__GLIBCXX__)
#define LGABENCH_STRINGS "old"
#else
#define LGABENCH_STRINGS "plain"
#endif

// Debug iterators change the layout of containers. NDEBUG and _GLIBCXX_ASSERTIONS do not, and may differ.
#if defined(_GLIBCXX_DEBUG)
#define LGABENCH_ITERATORS "debug"
#else
#define LGABENCH_ITERATORS "plain"
#endif

#if !defined(__has_feature)
#define LGABENCH_HAS_FEATURE(x) 0
#else
#define LGABENCH_HAS_FEATURE(x) __has_feature(x)
#endif
#if defined(__SANITIZE_ADDRESS__) || LGABENCH_HAS_FEATURE(address_sanitizer)
#define LGABENCH_SANITIZER "address"
#elif defined(__SANITIZE_THREAD__) || LGABENCH_HAS_FEATURE(thread_sanitizer)
#define LGABENCH_SANITIZER "thread"
#elif LGABENCH_HAS_FEATURE(memory_sanitizer)
#define LGABENCH_SANITIZER "memory"
#else
#define LGABENCH_SANITIZER "none"
#endif

// Defined by lgabench_add_plugin() for a plugin that links LibTorch, whose find_package() comes before it.
#if defined(LGABENCH_TORCH_VERSION)
#define LGABENCH_TORCH LGABENCH_TORCH_VERSION
#else
#define LGABENCH_TORCH "none"
#endif

#if defined(__clang__)
#define LGABENCH_COMPILER __VERSION__
#else
#define LGABENCH_COMPILER "gcc " __VERSION__
#endif

// -ffast-math and -Ofast. In sight, not refused: results then depend on compiler and processor.
#if defined(__FAST_MATH__)
#define LGABENCH_ARITHMETIC ";arithmetic=fast"
#else
#define LGABENCH_ARITHMETIC ""
#endif

/// "key=value;..." of the translation unit that expands it. The compiler is information: it may differ.
#define LGABENCH_FINGERPRINT                                                                                           \
  "architecture=" LGABENCH_ARCHITECTURE ";standard library=" LGABENCH_STANDARD_LIBRARY ";string ABI=" LGABENCH_STRINGS \
  ";iterators=" LGABENCH_ITERATORS ";sanitizer=" LGABENCH_SANITIZER ";SDK=" LGABENCH_VERSION                           \
  ";LibTorch=" LGABENCH_TORCH LGABENCH_ARITHMETIC ";compiler=" LGABENCH_COMPILER
