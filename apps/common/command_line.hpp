// Forward declarations of the option reader's types: its header takes seconds to compile.
#pragma once

namespace CLI {

class App;
class Validator;

}  // namespace CLI
