#include "apps/mpi/mpi_world.h"

#include <fmt/format.h>

#include <array>

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
    for (MPI_Comm* comm : {&data, &exchanges, &messages}) {
      check(MPI_Comm_dup(kWorld, comm), "MPI_Comm_dup");
      check(MPI_Comm_set_errhandler(*comm, kReturnErrors), "MPI_Comm_set_errhandler");
    }
  }
  hosts = host_names(data, count);
}

MpiGroup MpiWorld::split(int group) const {
  MpiGroup part;
  {
    const std::lock_guard lock(mpi_mutex());
    for (MPI_Comm* comm : {&part.data, &part.exchanges}) {
      check(MPI_Comm_split(kWorld, group, rank, comm), "MPI_Comm_split");
      check(MPI_Comm_set_errhandler(*comm, kReturnErrors), "MPI_Comm_set_errhandler");
    }
    check(MPI_Comm_rank(part.data, &part.rank), "MPI_Comm_rank");
    check(MPI_Comm_size(part.data, &part.count), "MPI_Comm_size");
  }
  part.hosts = host_names(part.data, part.count);
  return part;
}

void MpiWorld::finalize(std::vector<MpiGroup> groups) {
  const std::lock_guard lock(mpi_mutex());
  for (MpiGroup& group : groups) {
    for (MPI_Comm* comm : {&group.data, &group.exchanges}) check(MPI_Comm_free(comm), "MPI_Comm_free");
  }
  for (MPI_Comm* comm : {&data, &exchanges, &messages}) check(MPI_Comm_free(comm), "MPI_Comm_free");
  check(MPI_Finalize(), "MPI_Finalize");
}

std::string MpiGroup::name_of(int number) const {
  return fmt::format("rank {} of {} ({})", number, count, hosts[static_cast<std::size_t>(number)]);
}

}  // namespace gatelight::apps
