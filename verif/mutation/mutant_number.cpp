// The selector of the instrumented RTL: the environment chooses the mutant that runs. 0 is the unmodified design.
#include <cstdlib>

extern "C" int trammel_mutant() {
  const char* text = std::getenv("TRAMMEL_MUTANT");
  return text ? static_cast<int>(std::strtol(text, nullptr, 10)) : 0;
}
