#include "trammel/panel/texts.hpp"

#include <fmt/format.h>

#include <map>

namespace trammel::panel {

std::string error_text(int number) {
  static const std::map<int, const char*> kTexts{{1, "a word must begin with a letter"},
                                                 {2, "a number is missing or unreadable"},
                                                 {3, "the controller has no such command"},
                                                 {4, "a value is negative"},
                                                 {5, "the machine file has no homing switches, or homing is off"},
                                                 {8, "the machine must stand"},
                                                 {9, "the machine is locked by an alarm or moves"},
                                                 {11, "the line is too long"},
                                                 {15, "the target is beyond a soft limit"},
                                                 {16, "the jog has a word that jogs do not have"},
                                                 {20, "the controller does not have this G-code or this word"},
                                                 {21, "two words of one modal group"},
                                                 {22, "there is no feed"},
                                                 {23, "the value must be a whole number"},
                                                 {24, "two words of the line both need the axis words"},
                                                 {25, "a word comes twice"},
                                                 {26, "axis words are missing"},
                                                 {27, "the line number is out of range"},
                                                 {28, "a word is missing that this G-code needs"},
                                                 {29, "there is no such coordinate system"},
                                                 {30, "G53 needs G0 or G1"},
                                                 {31, "axis words that nothing uses"},
                                                 {32, "an arc has no axis words in its plane"},
                                                 {33, "the target is invalid"},
                                                 {34, "the arc's radius does not fit its ends"},
                                                 {35, "an arc lacks its centre in the plane"},
                                                 {36, "words that nothing uses"},
                                                 {37, "G43.1 is for the axis of the tool's length only"}};
  const auto text = kTexts.find(number);
  return fmt::format("{} (error {})", text == kTexts.end() ? "the line was refused" : text->second, number);
}

std::string alarm_text(int number) {
  switch (number) {
    case 0:
      return "Not homed since it was switched on";
    case 1:
      return "Stopped by the card: a limit switch, a drive or another fault";
    case 2:
      return "A target is beyond a soft limit";
    case 3:
      return "The position may be lost";
    case 4:
      return "The probe touched before the probing began";
    case 5:
      return "The probe did not touch";
    case 6:
      return "Stopped while homing";
    case 9:
      return "Homing failed";
    case 10:
      return "Emergency stop";
    default:
      return fmt::format("Alarm {}", number);
  }
}

}  // namespace trammel::panel
