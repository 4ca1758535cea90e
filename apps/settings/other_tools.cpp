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
    Word{"--bounces", "--max-depth N (bounces + 1)"},
    Word{"--cam", "--camera NAME"},
    Word{"--crop", "--region x0,y0,x1,y1"},
    Word{"--cropwindow", "--region x0,y0,x1,y1"},
    Word{"--denoise", "--denoiser auto"},
    Word{"--depth", "--max-depth N"},
    Word{"--display-server", "gatelight view SCENE"},
    Word{"-E", "--integrator NAME"},
    Word{"--engine", "--integrator NAME"},
    Word{"--env", "--environment FILE"},
    Word{"--envmap", "--environment FILE"},
    Word{"-f", "--frames N:N"},
    Word{"-F", "-o FILE.exr or -o FILE.png"},
    Word{"--film-transparent", "--background transparent"},
    Word{"--focal-length", "--lens MM"},
    Word{"--format", "-o FILE.exr or -o FILE.png"},
    Word{"--frame", "--frames N:N"},
    Word{"--gpu", "--device vulkan"},
    Word{"--hdri", "--environment FILE"},
    Word{"--height", "--size WxH"},
    Word{"--interactive", "gatelight view SCENE"},
    Word{"--max-bounces", "--max-depth N (bounces + 1)"},
    Word{"--motion-blur", "--shutter OPEN:CLOSE"},
    Word{"-n", "--threads N"},
    Word{"--noise-threshold", "--max-error E"},
    Word{"--nthreads", "--threads N"},
    Word{"--out", "-o FILE"},
    Word{"--outfile", "-o FILE"},
    Word{"--pixelsamples", "--spp N"},
    Word{"--quick", "--preset preview"},
    Word{"--render-output", "-o FILE"},
    Word{"--resolution", "--size WxH"},
    Word{"--resolution-percentage", "--size WxH"},
    Word{"-s", "--spp N, or --frames A:B"},
    Word{"--sample-count", "--spp N"},
    Word{"--samples", "--spp N"},
    Word{"--samples-per-pixel", "--spp N"},
    Word{"-t", "--threads N"},
    Word{"--time-budget", "--time-limit SECONDS"},
    Word{"--transparent", "--background transparent"},
    Word{"-v", "--verbose"},
    Word{"--width", "--size WxH"},
    Word{"--world", "--environment FILE"},
};

}  // namespace

std::string flag_of_other_tools(std::string_view flag) {
  for (const Word& word : kWords) {
    if (word.theirs == flag) return std::string(word.ours);
  }
  return "";
}

}  // namespace gatelight::apps
