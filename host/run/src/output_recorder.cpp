#include "trammel/run/output_recorder.hpp"

#include "csv.hpp"

namespace trammel::run {

OutputRecorder::OutputRecorder(TextSink* list) {
  if (list != nullptr) list_ = std::make_unique<CsvWriter>(*list, "cycle,output,level");
}

OutputRecorder::~OutputRecorder() = default;

void OutputRecorder::outputs_changed(const driver::OutputChange& change) {
  for (std::size_t n = 0; n < outputs_.size(); ++n) {
    if ((change.changed >> n & 1) == 0) continue;
    Output& output = outputs_[n];
    output.level = (change.levels >> n & 1) != 0;
    ++(output.level ? output.on : output.off);
    if (list_) {
      list_->row({static_cast<std::int64_t>(change.cycle), static_cast<std::int64_t>(n), output.level ? 1 : 0});
    }
  }
}

void OutputRecorder::finish() {
  if (list_) list_->finish();
}

}  // namespace trammel::run
