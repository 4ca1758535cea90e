#pragma once
// The processes that run one `gatelight render` together. In `gatelight` it is one, which works alone;
// gatelight-mpi has a team of several.

#include <exception>
#include <set>
#include <string>
#include <vector>

#include "apps/reports/run_report.h"
#include "apps/settings/render_settings.h"
#include "apps/terminal/signals.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// The results of the frames of one camera.
struct FrameResults {
  int signal = 0;  ///< that ended them; 0: none
  std::size_t done = 0;
  std::set<std::string> warnings;
  std::exception_ptr failure;  ///< that of the first frame which failed
};

/// All processes call the same functions in the same order.
class RunTeam {
 public:
  RunTeam() = default;
  virtual ~RunTeam() = default;
  RunTeam(const RunTeam&) = delete;
  RunTeam& operator=(const RunTeam&) = delete;

  /// Settles what the processes share: frames, processors and pictures. Throws BadOption.
  virtual void join(RenderSettings& settings);
  /// Throws InputError or OutOfMemory where they cannot make these pictures together.
  virtual void check(const RenderSettings& settings, const scene::Scene& scene) const;
  /// The answer of the one that prints, for all.
  virtual bool agreed(bool mine) const { return mine; }

  // With --frame-groups each group makes frames of its own. The rest is about a picture and its processes,
  // which are all of them before join().

  virtual bool is_alone() const { return true; }
  /// Whether this process gets the pictures and writes them.
  virtual bool writes() const { return true; }
  /// Returns when the one that writes has come here.
  virtual void wait_for_writer() const {}
  /// The signal that one of them received; 0: none.
  virtual int signal() const { return stop_signal(); }
  /// Adds what each of them did.
  virtual void describe(RunReport&) const {}

  /// The frames of this process.
  virtual std::vector<int> own_frames(std::vector<int> all) const { return all; }
  /// The results of all frames; the warnings are those that were printed nowhere.
  virtual FrameResults joined(const FrameResults& own) const {
    return {own.signal, own.done, {}, own.failure};
  }
};

}  // namespace gatelight::apps
