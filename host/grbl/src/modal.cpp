#include "trammel/grbl/modal.hpp"

#include <fmt/format.h>

namespace trammel::grbl {

std::string g_word(int tenths) {
  constexpr int kTenths = 10;
  return tenths % kTenths == 0 ? fmt::format("G{}", tenths / kTenths)
                               : fmt::format("G{}.{}", tenths / kTenths, tenths % kTenths);
}

std::string parser_state(const Modal& modal, bool report_inches) {
  std::string text =
      fmt::format("[GC:{} G{} G{} G{} G{} G{} M{}", g_word(modal.motion), modal.system, modal.plane,
                  modal.inches ? 20 : 21, modal.absolute ? 90 : 91, modal.inverse_time ? 93 : 94, modal.spindle);
  if (modal.mist) text += " M7";
  if (modal.flood) text += " M8";
  if (!modal.mist && !modal.flood) text += " M9";
  const double feed = report_inches ? modal.feed / 25.4 : modal.feed;
  return text + fmt::format(" T{} F{:.{}f} S{:.0f}]", modal.tool, feed, report_inches ? 1 : 0, modal.speed);
}

std::string preamble(const Modal& modal) {
  std::string text = fmt::format("G21 G94 G{}", modal.plane);
  if (modal.feed > 0) text += fmt::format(" F{:.9f}", modal.feed);
  if (modal.tool_length != 0) text += fmt::format("\nG90 G43.1 Z{:.9f}", modal.tool_length);
  text +=
      fmt::format("\nG{} G{} G{}\n", modal.absolute ? 90 : 91, modal.inches ? 20 : 21, modal.inverse_time ? 93 : 94);
  return text;
}

}  // namespace trammel::grbl
