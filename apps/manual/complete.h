#pragma once
// Words that may follow on the command line, for the Tab key of shells.

#include <cstddef>
#include <string>
#include <vector>

#include "apps/manual/program_text.h"

namespace gatelight::apps {

struct Completion {
  struct Candidate {
    std::string word;  ///< the whole word, with its typed part
    std::string help;  ///< in short; may be empty
  };
  std::vector<Candidate> candidates;
  bool goes_on = false;  ///< no space follows the candidates
  bool files = false;    ///< files may follow too, and folders on the way to them
  bool folders = false;
  std::vector<std::string> extensions;  ///< of the files, without their points; empty: any
  std::size_t begin = 0;                ///< bytes of the word before the name of a file
};

/// `words`: those after the program's name, without quotes; the last one is being typed and may be empty.
Completion complete(const ProgramText& program, const std::vector<std::string>& words);

/// The answer to the scripts of the shells: a line "WORD<tab>HELP" for each candidate, then one of these:
/// ":words", ":open" (no space follows), ":files<tab>BEGIN<tab>EXTENSION EXTENSION", ":folders<tab>BEGIN".
std::string text_of(const Completion& completion);

}  // namespace gatelight::apps
