// Standard input and output as one stream of bytes.
#pragma once

#include <memory>

#include "trammel/transport/byte_stream.hpp"

namespace trammel::app {

// Its end is the end of standard input.
std::unique_ptr<transport::ByteStream> standard_stream();

}  // namespace trammel::app
