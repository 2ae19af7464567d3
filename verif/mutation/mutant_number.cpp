// The selector of the instrumented RTL: which mutant runs, from the environment. 0 is the sound design.
#include <cstdlib>

extern "C" int trammel_mutant() {
  const char* text = std::getenv("TRAMMEL_MUTANT");
  return text ? static_cast<int>(std::strtol(text, nullptr, 10)) : 0;
}
