// The operations of one run as lines of G-code, as they arrive. The run ends when no operation arrives for a moment;
// the planner then plans a stop before the card could run out of commands. Internal to the path server.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>

#include "trammel/gcode/line_source.hpp"
#include "trammel/linuxcnc/path_server.hpp"

namespace trammel::linuxcnc {

class PathLines final : public gcode::LineSource {
 public:
  // `from`: the start position of the run.
  PathLines(PathServer& server, const Pose& from) : server_(server), from_(from) {}
  bool next(std::string_view& line) override;
  const std::string& name() const override { return name_; }

 private:
  bool wait_for_operation();
  bool may_wait() const;
  bool still_come() const;
  void take(const trammel_operation& operation);

  PathServer& server_;
  std::string name_ = "linuxcnc";
  Pose from_;
  std::string modes_;                // units and path control in force
  std::deque<std::string> pending_;  // lines to give next
  std::string given_;
  std::size_t lines_ = 0;
  bool ended_ = false;
};

}  // namespace trammel::linuxcnc
