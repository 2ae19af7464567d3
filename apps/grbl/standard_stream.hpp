// Standard input and output as one stream of bytes.
#pragma once

#include <memory>

#include "trammel/transport/byte_stream.hpp"

namespace trammel::app {

// The stream ends when standard input ends.
std::unique_ptr<transport::ByteStream> standard_stream();

}  // namespace trammel::app
