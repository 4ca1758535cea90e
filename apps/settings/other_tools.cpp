#include "apps/settings/other_tools.h"

#include <array>

namespace gatelight::apps {
namespace {

struct Word {
  std::string_view theirs, ours;
};

constexpr std::array kWords = {
    Word{"-b", "gatelight render SCENE -o FILE"},
    Word{"--bounces", "--max-depth N (bounces + 1)"},
    Word{"--crop", "--region x0,y0,x1,y1"},
    Word{"--denoise", "--denoiser auto"},
    Word{"--depth", "--max-depth N"},
    Word{"--env", "--environment FILE"},
    Word{"--envmap", "--environment FILE"},
    Word{"--frame", "--frames N:N"},
    Word{"--gpu", "--device vulkan"},
    Word{"--hdri", "--environment FILE"},
    Word{"--height", "--size WxH"},
    Word{"--max-bounces", "--max-depth N (bounces + 1)"},
    Word{"--motion-blur", "--shutter OPEN:CLOSE"},
    Word{"--noise-threshold", "--max-error E"},
    Word{"--nthreads", "--threads N"},
    Word{"--out", "-o FILE"},
    Word{"--outfile", "-o FILE"},
    Word{"--resolution", "--size WxH"},
    Word{"-s", "--spp N, or --frames A:B"},
    Word{"--samples", "--spp N"},
    Word{"-t", "--threads N"},
    Word{"--transparent", "--background transparent"},
    Word{"--width", "--size WxH"},
};

}  // namespace

std::string flag_of_other_tools(std::string_view flag) {
  for (const Word& word : kWords) {
    if (word.theirs == flag) return std::string(word.ours);
  }
  return "";
}

}  // namespace gatelight::apps
