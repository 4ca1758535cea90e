// The kernels of reconstruction, compiled once for each instruction set. GATELIGHT_KERNEL_TABLE is the name
// of the table.

#include "renderer/reconstruction/kernel_regression.h"
#include "renderer/reconstruction/kernel_tables.h"

namespace gatelight::renderer {
namespace {

void fit_row(const BandView& band, const FitView& out, int y, int fitted, float bandwidth) {
  const Columns columns(band);
  for (int first = 0; first < band.columns; first += kTogether) {
    if (band.guide_count == kMostGuides) {
      fit_windows<kMostGuides>(band, columns, out, y, first, fitted, bandwidth);
    } else {
      fit_windows<kFewestGuides>(band, columns, out, y, first, fitted, bandwidth);
    }
  }
}

}  // namespace

const ReconstructionKernels GATELIGHT_KERNEL_TABLE = {fit_row};

}  // namespace gatelight::renderer
