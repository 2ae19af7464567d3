// The option reader's types by their names: its own header takes seconds to compile.
#pragma once

namespace CLI {

class App;
class Validator;

}  // namespace CLI
