#pragma once
// The ranks that run one `gatelight-mpi render`, and their groups of frames (--frame-groups).

#include <vector>

#include "apps/mpi/mpi_ranks.h"
#include "apps/render/run_team.h"

namespace gatelight::apps {

class MpiTeam final : public RunTeam {
 public:
  /// Of several ranks.
  explicit MpiTeam(MpiRanks& mpi) : mpi_(mpi) {}

  void join(RenderSettings& settings) override;
  void check(const RenderSettings& settings, const scene::Scene& scene) const override;
  bool agreed(bool mine) const override { return mpi_.all().agreed(mine); }
  bool is_alone() const override { return own_->is_single(); }
  bool writes() const override { return own_->first(); }
  void wait_for_writer() const override { own_->agreed(0); }
  int signal() const override;
  void describe(RunReport& report) const override;
  std::vector<int> own_frames(std::vector<int> all) const override;
  FrameResults joined(const FrameResults& own) const override;

 private:
  MpiRanks& mpi_;
  int groups_ = 1;
  MpiCollectives* own_ = &mpi_.all();  ///< the group of this rank
};

}  // namespace gatelight::apps
