// The version of the framework and of its plugin interface.
#pragma once

#define LGABENCH_VERSION "0.5.0"
/// Raised whenever a type that crosses the plugin boundary changes.
#define LGABENCH_PLUGIN_ABI 6
