#include "apps/settings/other_tools.h"

#include <array>

namespace gatelight::apps {
namespace {

struct Word {
  std::string_view theirs, ours;
};

constexpr std::array kWords = {
    Word{"-a", "--frames A:B"},
    Word{"-b", "gatelight render SCENE -o FILE"},
    Word{"--background-color", "--background r,g,b"},
    Word{"--bounces", "--max-depth N"},
    Word{"--crop", "--region x0,y0,x1,y1"},
    Word{"--cropwindow", "--region x0,y0,x1,y1"},
    Word{"--denoise", "--denoiser auto"},
    Word{"--depth", "--max-depth N"},
    Word{"--display-server", "--live HOST:PORT"},
    Word{"-E", "--integrator NAME"},
    Word{"--engine", "--integrator NAME"},
    Word{"--env", "--environment FILE"},
    Word{"--envmap", "--environment FILE"},
    Word{"-f", "--frames N:N"},
    Word{"--frame", "--frames N:N"},
    Word{"--gpu", "--device vulkan"},
    Word{"--hdri", "--environment FILE"},
    Word{"--height", "--size WxH"},
    Word{"--interactive", "gatelight view SCENE"},
    Word{"--max-bounces", "--max-depth N"},
    Word{"-n", "--threads N"},
    Word{"--nthreads", "--threads N"},
    Word{"--out", "-o FILE"},
    Word{"--outfile", "-o FILE"},
    Word{"--pixelsamples", "--spp N"},
    Word{"--quick", "--preset preview"},
    Word{"-s", "--spp N, or --frames A:B"},
    Word{"--sample-count", "--spp N"},
    Word{"--samples", "--spp N"},
    Word{"-t", "--threads N"},
    Word{"--time-budget", "--time-limit SECONDS"},
    Word{"-v", "--verbose"},
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
