#include "apps/mpi/mpi_world.h"

#include <array>

#include "apps/ranks/rank_group.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

using HostName = std::array<char, MPI_MAX_PROCESSOR_NAME + 1>;

std::vector<std::string> host_names(MPI_Comm comm, int count) {
  struct Names {
    HostName mine{};
    std::vector<HostName> all;
    Requests requests{kNoRequest};
  };
  const MpiMemory<Names> names;
  names->all.resize(static_cast<std::size_t>(count));
  {
    const std::lock_guard lock(mpi_mutex());
    int length = 0;
    check(MPI_Get_processor_name(names->mine.data(), &length), "MPI_Get_processor_name");
    constexpr int kSize = sizeof(HostName);
    check(MPI_Iallgather(names->mine.data(), kSize, kByte, names->all.data(), kSize, kByte, comm,
                         names->requests.data()),
          "MPI_Iallgather");
  }
  wait_for(names->requests);
  std::vector<std::string> hosts;
  for (const HostName& name : names->all) hosts.emplace_back(name.data());
  return hosts;
}

int ranks_of_this_machine(int rank) {
  MPI_Comm local = kNoComm;
  int count = 1;
  check(MPI_Comm_split_type(kWorld, MPI_COMM_TYPE_SHARED, rank, kNoInfo, &local), "MPI_Comm_split_type");
  check(MPI_Comm_size(local, &count), "MPI_Comm_size");
  check(MPI_Comm_free(&local), "MPI_Comm_free");
  return count;
}

}  // namespace

MpiWorld::MpiWorld(int* argc, char*** argv) {
  {
    const std::lock_guard lock(mpi_mutex());
    int threads = MPI_THREAD_SINGLE;
    check(MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &threads), "MPI_Init_thread");
    if (threads < MPI_THREAD_SERIALIZED) {
      MPI_Finalize();
      throw MpiError("this MPI cannot be called by several threads (MPI_THREAD_SERIALIZED)");
    }
    check(MPI_Comm_set_errhandler(kWorld, kReturnErrors), "MPI_Comm_set_errhandler");
    check(MPI_Comm_rank(kWorld, &rank), "MPI_Comm_rank");
    check(MPI_Comm_size(kWorld, &count), "MPI_Comm_size");
    local_count = ranks_of_this_machine(rank);
    for (MPI_Comm* comm : {&data, &all_gathers, &messages}) {
      check(MPI_Comm_dup(kWorld, comm), "MPI_Comm_dup");
      check(MPI_Comm_set_errhandler(*comm, kReturnErrors), "MPI_Comm_set_errhandler");
    }
  }
  hosts = host_names(data, count);
}

MpiGroup MpiWorld::split(int group) const {
  const std::lock_guard lock(mpi_mutex());
  MpiGroup part;
  for (MPI_Comm* comm : {&part.data, &part.all_gathers}) {
    check(MPI_Comm_split(kWorld, group, rank, comm), "MPI_Comm_split");
    check(MPI_Comm_set_errhandler(*comm, kReturnErrors), "MPI_Comm_set_errhandler");
  }
  check(MPI_Comm_rank(part.data, &part.rank), "MPI_Comm_rank");
  check(MPI_Comm_size(part.data, &part.count), "MPI_Comm_size");
  return part;
}

void MpiWorld::finalize(std::vector<MpiGroup> groups) {
  const std::lock_guard lock(mpi_mutex());
  for (MpiGroup& group : groups) {
    for (MPI_Comm* comm : {&group.data, &group.all_gathers}) check(MPI_Comm_free(comm), "MPI_Comm_free");
  }
  for (MPI_Comm* comm : {&data, &all_gathers, &messages}) check(MPI_Comm_free(comm), "MPI_Comm_free");
  check(MPI_Finalize(), "MPI_Finalize");
}

std::string name_of(const MpiWorld& world, int rank) {
  return name_of_rank(rank, world.count, world.hosts[static_cast<std::size_t>(rank)]);
}

}  // namespace gatelight::apps
