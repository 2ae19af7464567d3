// Records a card's outputs: the switching counts and the present level of each. Not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "trammel/driver/steps.hpp"
#include "trammel/machine/machine.hpp"
#include "trammel/run/text_sink.hpp"

namespace trammel::run {

class CsvWriter;

class OutputRecorder final : public driver::StepSink {
 public:
  struct Output {
    std::uint64_t on = 0;   // rising edges
    std::uint64_t off = 0;  // falling edges
    bool level = false;     // present level
  };

  // `list`: gets every change as a row cycle,output,level; not owned, may be nullptr.
  explicit OutputRecorder(TextSink* list = nullptr);
  ~OutputRecorder() override;

  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& /*step*/) override {}
  void outputs_changed(const driver::OutputChange& change) override;
  // Writes the rest of the list.
  void finish();

  const std::array<Output, machine::kMaxOutputs>& outputs() const { return outputs_; }

 private:
  std::array<Output, machine::kMaxOutputs> outputs_{};
  std::unique_ptr<CsvWriter> list_;
};

}  // namespace trammel::run
