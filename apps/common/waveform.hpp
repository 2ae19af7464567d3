// Checks whether a waveform file is complete, because its writer does not check whether the disk accepted it.
#pragma once

#include <string>

namespace trammel::app {

// An FST file is a sequence of blocks, each with its length: they must cover the file and include geometry and
// hierarchy. Throws std::runtime_error, naming `name`, if they do not.
void require_whole_waveform(const std::string& path, const std::string& name);

}  // namespace trammel::app
