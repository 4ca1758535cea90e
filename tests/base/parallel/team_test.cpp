#include "base/parallel/team.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <functional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/parallel/loops.h"

namespace gatelight {
namespace {

/// More threads than cores is the hardest case: any of them may be interrupted anywhere.
constexpr int kThreads[] = {1, 2, 3, 7, 16};

template <class Function>
void on_threads(int threads, const Function& function) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  tbb::task_arena(threads).execute(function);
}

TEST(Team, LoopsVisitEachIndexOnceAndFollowEachOther) {
  for (const int threads : kThreads) {
    on_threads(threads, [&] {
      std::vector<std::uint32_t> sums(300, 0);
      Team::run([&](Team& team) {
        for (std::uint32_t loop = 1; loop <= 400; ++loop) {
          // Sizes change, so that an index of one loop could be none of the next.
          const std::uint32_t size = loop % 3 == 0 ? 300 : loop % 3 == 1 ? 1 : 43;
          // Plain numbers: a loop has ended before the next begins.
          team.for_each(size, [&](std::uint32_t begin, std::uint32_t end) {
            for (std::uint32_t i = begin; i < end; ++i) sums[i] += loop;
          });
        }
      });
      std::uint32_t first = 0, small = 0, large = 0;
      for (std::uint32_t loop = 1; loop <= 400; ++loop) {
        first += loop;
        small += loop % 3 != 1 ? loop : 0;
        large += loop % 3 == 0 ? loop : 0;
      }
      EXPECT_EQ(sums[0], first);
      for (std::size_t i = 1; i < 43; ++i) EXPECT_EQ(sums[i], small);
      for (std::size_t i = 43; i < 300; ++i) EXPECT_EQ(sums[i], large);
    });
  }
}

TEST(Team, TasksRunOnceBesideTheLead) {
  for (const int threads : kThreads) {
    on_threads(threads, [&] {
      std::vector<std::atomic<int>> done(500);
      std::atomic<int> in_loops = 0;
      Team::run([&](Team& team) {
        for (int times = 0; times < 5; ++times) {
          team.beside(
              static_cast<std::uint32_t>(done.size()), [&](std::size_t i) { ++done[i]; },
              [&] {
                for (int loop = 0; loop < 50; ++loop)
                  team.for_each(20, [&](std::uint32_t begin, std::uint32_t end) {
                    in_loops += static_cast<int>(end - begin);
                  });
              });
        }
      });
      EXPECT_EQ(in_loops, 5000);
      for (const std::atomic<int>& count : done) EXPECT_EQ(count, 5);
    });
  }
}

/// Both indices of the loop wait for each other, so one thread alone could not end it.
void meet(const std::function<void(const std::function<void(std::size_t)>&)>& loop_of_two) {
  std::atomic<int> arrived = 0;
  loop_of_two([&](std::size_t) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

TEST(Team, OtherThreadsTakePartInItsLoopsAndInThoseThatItsLeadCalls) {
  on_threads(2, [] {
    Team::run([&](Team& team) {
      meet([&](const auto& body) {
        team.for_each(2, [&](std::uint32_t begin, std::uint32_t end) {
          ASSERT_EQ(end, begin + 1);
          body(begin);
        });
      });
      EXPECT_EQ(Team::led_here(), &team);
      meet([](const auto& body) { for_each(2, body); });
    });
    EXPECT_EQ(Team::led_here(), nullptr);
  });
}

TEST(Team, LoopsInsideLoopsAndTasksAreNotOfTheTeam) {
  for (const int threads : kThreads) {
    on_threads(threads, [&] {
      std::atomic<int> count = 0;
      Team::run([&](Team& team) {
        const auto inner = [&](std::size_t) {
          EXPECT_EQ(Team::led_here(), nullptr);
          for_each(3, [&](std::size_t) { ++count; });
        };
        team.beside(4, inner, [&] { for_each(5, inner); });
      });
      EXPECT_EQ(count, 27);
    });
  }
}

TEST(Team, AnExceptionOfALoopReachesTheLead) {
  for (const int threads : kThreads) {
    on_threads(threads, [&] {
      int caught = 0;
      std::atomic<int> after = 0;
      Team::run([&](Team& team) {
        try {
          for_each(100, [](std::size_t i) {
            if (i == 50) throw std::runtime_error("loop");
          });
        } catch (const std::runtime_error&) {
          ++caught;
        }
        team.for_each(
            30, [&](std::uint32_t begin, std::uint32_t end) { after += static_cast<int>(end - begin); });
      });
      EXPECT_EQ(caught, 1);
      EXPECT_EQ(after, 30);
    });
  }
}

TEST(Team, AnExceptionOfTheLeadOrOfATaskEndsTheRun) {
  for (const int threads : kThreads) {
    on_threads(threads, [&] {
      std::atomic<int> tasks = 0;
      const auto task = [&](std::size_t i) {
        ++tasks;
        if (i == 30) throw std::runtime_error("task");
      };
      EXPECT_THROW(Team::run([&](Team& team) {
                     team.beside(
                         10, [&](std::size_t) { ++tasks; }, [] { throw std::runtime_error("lead"); });
                   }),
                   std::runtime_error);
      EXPECT_LE(tasks, 10);
      tasks = 0;
      EXPECT_THROW(Team::run([&](Team& team) {
                     team.beside(100, task, [&] {
                       for (int loop = 0; loop < 20; ++loop)
                         team.for_each(9, [](std::uint32_t, std::uint32_t) {});
                     });
                   }),
                   std::runtime_error);
      EXPECT_GE(tasks, 31);
      EXPECT_EQ(Team::led_here(), nullptr);
    });
  }
}

}  // namespace
}  // namespace gatelight
