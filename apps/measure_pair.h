#pragma once
// Measures one picture against another, for `compare`.

#include "apps/reports/compare_report.h"
#include "renderer/metrics/beauty.h"

namespace gatelight::apps {

/// Sets the errors of the report. Pixels that are not finite are left out with a warning. Where a metric of
/// the report needs all pixels, or another use does (`others_need_all`), they are refused with InputError.
void measure_errors(CompareReport& report, const renderer::NamedPicture& reference,
                    const renderer::NamedPicture& test, bool others_need_all);

}  // namespace gatelight::apps
