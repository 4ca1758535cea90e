#pragma once
// Pages for man(1), made from the texts of the help.

#include <string>
#include <vector>

#include "apps/manual/program_text.h"

namespace gatelight::apps {

struct ManualPage {
  std::string name;    ///< "gatelight-render": the file is gatelight-render.1
  std::string source;  ///< roff
};

/// The page of the program, one of each subcommand, and one of gatelight-mpi.
std::vector<ManualPage> manual_pages(const ProgramText& program);

}  // namespace gatelight::apps
