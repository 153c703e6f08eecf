#pragma once

#include <string>
#include <vector>

namespace tactus::runtime {

/// Folder of the running program, symbolic links followed.  The build tree and an installed one are alike:
/// bin/tactus, lib/tactus/plugins, share/tactus/models.
std::string programFolder();

/// Where the shipped plugins stand: from the program's place, or from that of Tactus's library where the program is not
/// one of Tactus.
std::string shippedPluginFolder();

/// Where the shipped robot models stand, likewise.
std::string shippedModelFolder();

/// The folders of a list like PATH in environment variable `name`, empty ones left out.
std::vector<std::string> foldersFromEnvironment(const char* name);

}  // namespace tactus::runtime
