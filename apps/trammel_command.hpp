// The trammel command: subcommands, and what the shell sees when one fails.
#pragma once

namespace trammel::app {

// The exit status.
int run_command_line(int argc, char** argv, const char* version);

}  // namespace trammel::app
