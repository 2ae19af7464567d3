// Whether a waveform file is whole: who writes it does not look whether the disk took it.
#pragma once

#include <string>

namespace trammel::app {

// An FST file is a row of blocks, each with its length: they must cover the file, geometry and hierarchy among them.
// Throws std::runtime_error, naming `name`, when they do not.
void require_whole_waveform(const std::string& path, const std::string& name);

}  // namespace trammel::app
