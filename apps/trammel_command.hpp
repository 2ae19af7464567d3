// The trammel command: its subcommands, and exit status and messages when one fails.
#pragma once

namespace trammel::app {

// Returns the exit status.
int run_command_line(int argc, char** argv, const char* version);

}  // namespace trammel::app
