/**
 * @file mpm_mpi.hpp
 * C++17: one problem on the processes of MPI. See mpm_mpi.h and mpm.hpp.
 */
#ifndef MPM_MPI_HPP
#define MPM_MPI_HPP

#include <mpm/mpm.hpp>
#include <mpm/mpm_mpi.h>

namespace mpm {

/** How files are written: see mpm_mpi_output. */
struct mpi_output {
  int32_t writers = 0;             /**< processes that write; 0: one on each machine */
  std::vector<std::string> fields; /**< names; empty: every field in use */
};

/**
 * The processes of a communicator. It is made before the context and outlives it and everything made with it:
 * declare it first. Where it ends, all processes have to come.
 *
 *     mpm::context_desc services;
 *     mpm::mpi world(MPI_COMM_WORLD, services);
 *     mpm::context context(services);
 */
class mpi {
public:
  /** Joins them and sets desc.transport: see mpm_mpi_open(). Of desc only plain pointers reach the library,
   * no function objects. error::what() has the sentence that says why it cannot. */
  mpi(MPI_Comm comm, context_desc &desc) {
    char text[1024] = "";
    char *const of_host = desc.error_text;
    const uint64_t bytes = desc.error_bytes;
    if (!of_host) desc.error_text = text, desc.error_bytes = sizeof text;
    const mpm_status status = mpm_mpi_open(comm, &desc, &handle_);
    const std::string sentence = status ? desc.error_text : "";
    desc.error_text = of_host;
    desc.error_bytes = bytes;
    if (status) throw error(status, sentence.c_str());
  }
  /** Takes the handle over. */
  mpi(mpi &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  /** Lets go of its handle and takes the other over. */
  mpi &operator=(mpi &&other) noexcept {
    if (this != &other) mpm_mpi_close(std::exchange(handle_, std::exchange(other.handle_, nullptr)));
    return *this;
  }
  /** Leaves the processes: see mpm_mpi_close(). */
  ~mpi() {
    mpm_mpi_close(handle_);
  }

  /** The handle, for calls of the C interface. It stays the object's. NULL once it was moved from. */
  mpm_mpi *handle() const noexcept {
    return handle_;
  }
  /** Writes a set: see mpm_mpi_write_particles(). */
  void write(const particles &set, const std::string &path, const mpi_output &output = {}) const {
    named plain(output);
    check(mpm_mpi_write_particles(handle_, set.handle(), path.c_str(), &plain.c));
  }
  /** Writes nodal fields: see mpm_mpi_write_grid(). */
  void write_grid(const stepper &of, const std::string &path, const mpi_output &output = {}) const {
    named plain(output);
    check(mpm_mpi_write_grid(handle_, of.handle(), path.c_str(), &plain.c));
  }
  /** Writes the state: see mpm_mpi_save(). */
  void save(const stepper &of, const std::string &path) const {
    check(mpm_mpi_save(handle_, of.handle(), path.c_str()));
  }
  /** Replaces the state: see mpm_mpi_load(). */
  void load(const stepper &into, const std::string &path) const {
    check(mpm_mpi_load(handle_, into.handle(), path.c_str()));
  }

private:
  /* What C takes, while it lives. */
  struct named {
    explicit named(const mpi_output &output) {
      for (const std::string &field : output.fields) names.push_back(field.c_str());
      c.struct_size = sizeof c;
      c.writers = output.writers;
      c.count = static_cast<int32_t>(names.size());
      c.fields = names.empty() ? nullptr : names.data();
    }
    named(const named &) = delete;
    named &operator=(const named &) = delete;
    std::vector<const char *> names;
    mpm_mpi_output c{};
  };

  void check(mpm_status status) const {
    if (status) throw error(status, mpm_mpi_last_error(handle_));
  }

  mpm_mpi *handle_ = nullptr;
};

} // namespace mpm

#endif
