#include "trammel_command.hpp"

int main(int argc, char** argv) { return trammel::app::run_command_line(argc, argv, TRAMMEL_VERSION); }
