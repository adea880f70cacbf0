#include "cluster.h"

#include <fmt/format.h>

#include <cstdlib>

#include "spark/error.h"
#ifdef SPARK_MPI
#include <mpi.h>
#endif

namespace sparkbatch {

namespace {
#ifdef SPARK_MPI
class MpiCluster : public Cluster {
 public:
  MpiCluster() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &number_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, number_, MPI_INFO_NULL, &machine);
    MPI_Comm_size(machine, &neighbours_);
    MPI_Comm_free(&machine);
  }
  ~MpiCluster() override { MPI_Finalize(); }
  MpiCluster(const MpiCluster&) = delete;
  MpiCluster& operator=(const MpiCluster&) = delete;

  int number() const override { return number_; }
  int size() const override { return size_; }
  int neighbours() const override { return neighbours_; }
  void send(int to, MessageKind kind, const std::string& text) override {
    MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, static_cast<int>(kind), MPI_COMM_WORLD);
  }
  std::optional<Message> receive() override {
    int available = 0, length = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &available, &status);
    if (!available) return std::nullopt;
    MPI_Get_count(&status, MPI_CHAR, &length);
    Message m{status.MPI_SOURCE, static_cast<MessageKind>(status.MPI_TAG),
              std::string(static_cast<std::size_t>(length), ' ')};
    MPI_Recv(m.text.data(), length, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return m;
  }
  void abort(int code) override { MPI_Abort(MPI_COMM_WORLD, code); }

 private:
  int number_ = 0, size_ = 1, neighbours_ = 1;
};
#endif
}  // namespace

/// Checks variables that are set by Open MPI's mpirun, by Slurm and others through PMIx, and by MPICH.
bool Cluster::started() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(name)) return true;
  return false;
}

namespace {
/// The number of tasks that Slurm's srun has started with this one; 1: none.
int tasksOfSlurm() {
  const char* const tasks = std::getenv("SLURM_STEP_NUM_TASKS") ? std::getenv("SLURM_STEP_NUM_TASKS")
                            : std::getenv("SLURM_STEP_ID") || std::getenv("SLURM_STEPID") ? std::getenv("SLURM_NTASKS")
                                                                                          : nullptr;
  return tasks ? std::atoi(tasks) : 1;
}
}  // namespace

std::unique_ptr<Cluster> Cluster::join() {
  if (!started() && tasksOfSlurm() > 1)
    throw spark::Error(
        fmt::format("Slurm started {} tasks of this program, but nothing that connects them: each would run the whole "
                    "batch. Say srun --mpi=pmix (srun --mpi=list shows what there is) or mpirun; or srun --ntasks=1 "
                    "--cpus-per-task=N for one process with N threads.",
                    tasksOfSlurm()));
  if (!started()) return std::make_unique<Cluster>();
#ifdef SPARK_MPI
  return std::make_unique<MpiCluster>();
#else
  throw spark::Error(
      "mpirun started this program, which was built without MPI: every process would run the whole batch. "
      "Install libopenmpi-dev and openmpi-bin, configure and build again.");
#endif
}

}  // namespace sparkbatch
