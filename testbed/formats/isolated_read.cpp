#include "testbed/formats/isolated_read.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <string>
#include <utility>

#include "core/error.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/system_reason.h"

namespace geoprior {
namespace {

namespace fs = std::filesystem;
using SteadyClock = std::chrono::steady_clock;

// The sanitizer maps terabytes, so that no limit of the address space fits, and its reports are
// wanted, though standard error be a file.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kAddressSanitizer = true;
#elif defined(__has_feature)
constexpr bool kAddressSanitizer = __has_feature(address_sanitizer);
#else
constexpr bool kAddressSanitizer = false;
#endif

constexpr int kBufferBytes = 1 << 20;
constexpr std::size_t kLongestMessage = 1 << 16;

/// What the child sends before its bytes.
struct ReplyHeader {
  enum class Kind : std::uint64_t { bytes, error, out_of_memory };
  Kind kind = Kind::bytes;
  std::uint64_t size = 0;
};

/// Bytes of the address space in use.
std::size_t mapped_bytes() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * ::sysconf(_SC_PAGESIZE);
}

/// What a parsing child is sent before a request.
struct RequestHeader {
  std::uint64_t size = 0;
  std::uint64_t memory = 0;
  double seconds = 0;
};

/// Both ends of a connection to a child; what is left open is closed at the end.
class Connection {
 public:
  explicit Connection(const fs::path& file) {
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()) != 0) {
      throw Error("cannot be read in a process of its own: " + system_reason(errno), file.string());
    }
    for (const int end : ends_)  // only makes it faster
      (void)::setsockopt(end, SOL_SOCKET, SO_SNDBUF, &kBufferBytes, sizeof kBufferBytes);
  }
  ~Connection() {
    ::close(ends_[0]);
    close_childs();
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  [[nodiscard]] int ours() const { return ends_[0]; }
  [[nodiscard]] int childs() const { return ends_[1]; }
  void close_childs() {
    if (ends_[1] >= 0) ::close(std::exchange(ends_[1], -1));
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// No signal reaches this thread, nor a child that it forks, before the child has left our
/// handlers.
class BlockedSignals {
 public:
  BlockedSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  BlockedSignals(const BlockedSignals&) = delete;
  BlockedSignals& operator=(const BlockedSignals&) = delete;

 private:
  sigset_t before_;
};

// In the child: nothing here returns to the caller of read_in_child.

void default_signals() {
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (int signal = 1; signal < NSIG; ++signal) (void)::sigaction(signal, &action, nullptr);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

void close_from(unsigned first, unsigned last) {
  if (first > last || ::close_range(first, last, 0) == 0) return;
  constexpr unsigned kMost = 1 << 16;  // a kernel without close_range
  for (unsigned i = first; i <= std::min(last, kMost); ++i) ::close(static_cast<int>(i));
}

/// Keeps the connection alone: a journal's lock must not outlive our parent, and the buffers of its
/// streams must not be written twice. Returns the connection's new descriptor.
int keep_only(int connection) {
  const int kept = ::fcntl(connection, F_DUPFD_CLOEXEC, 3);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  if (kept < 0 || nothing < 0) ::_exit(1);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (kAddressSanitizer && stream == STDERR_FILENO) continue;
    if (stream != nothing) ::dup2(nothing, stream);
  }
  const unsigned number = kept;
  close_from(3, number - 1);
  close_from(number + 1, ~0U);
  return kept;
}

/// @param for_good  no later limit may be higher
void set_limit(decltype(RLIMIT_AS) resource, rlim_t value, bool for_good) {
  rlimit limit{};
  if (::getrlimit(resource, &limit) != 0) ::_exit(1);
  limit.rlim_cur = std::min(limit.rlim_max, value);
  if (for_good) limit.rlim_max = limit.rlim_cur;
  if (::setrlimit(resource, &limit) != 0) ::_exit(1);
}

void write_no_files() {
  set_limit(RLIMIT_CORE, 0, true);
  if (!kAddressSanitizer) set_limit(RLIMIT_FSIZE, 0, true);
}

rlim_t seconds_used() {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) ::_exit(1);
  return usage.ru_utime.tv_sec + usage.ru_stime.tv_sec;
}

/// Limits of what follows.
void apply(const ChildLimits& limits, std::size_t mapped_before) {
  set_limit(RLIMIT_CPU, seconds_used() + static_cast<rlim_t>(std::ceil(limits.seconds)) + 2, false);
  if (!kAddressSanitizer) set_limit(RLIMIT_AS, mapped_before + limits.memory, false);
}

void send(int connection, ReplyHeader::Kind kind, std::string_view bytes) {
  const ReplyHeader header{kind, bytes.size()};
  write_all(connection, {reinterpret_cast<const char*>(&header), sizeof header}, "connection");
  write_all(connection, bytes, "connection");
}

/// False when there was something wrong.
bool reply(int connection, const std::function<std::vector<std::byte>()>& read) {
  try {
    const std::vector<std::byte> bytes = read();
    send(connection, ReplyHeader::Kind::bytes,
         {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    return true;
  } catch (const Error& e) {
    send(connection, ReplyHeader::Kind::error,
         std::string_view(e.what()).substr(0, kLongestMessage));
  } catch (const std::bad_alloc&) {
    send(connection, ReplyHeader::Kind::out_of_memory, {});
  }
  return false;
}

/// @return  the descriptor that is left
int begin_child(int descriptor, pid_t parent) {
  default_signals();
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int kept = keep_only(descriptor);
  write_no_files();
  return kept;
}

/// False at the end of what is sent.
bool receive_all(int connection, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::read(connection, bytes.data(), bytes.size());
    if (n == 0 || (n < 0 && errno != EINTR)) return false;
    if (n > 0) bytes = bytes.subspan(n);
  }
  return true;
}

/// Answers requests until there are no more, or something is wrong with one.
[[noreturn]] void serve(int connection, std::size_t mapped_before, ParsingChild::Parse parse) {
  try {
    RequestHeader header;
    while (receive_all(connection, std::as_writable_bytes(std::span(&header, 1)))) {
      apply({.memory = header.memory, .seconds = header.seconds}, mapped_before);
      const bool good = reply(connection, [&] {
        std::vector<std::byte> request(header.size);
        if (!receive_all(connection, request)) ::_exit(0);
        return parse(request);
      });
      if (!good) break;
    }
  } catch (...) {  // of a library; the parent sees that there is no whole reply
    ::_exit(1);
  }
  ::_exit(0);
}

[[noreturn]] void run_as_child(const Connection& connection, pid_t parent,
                               const ChildLimits& limits, std::size_t mapped_before,
                               const std::function<std::vector<std::byte>()>& read) {
  const int kept = begin_child(connection.childs(), parent);
  apply(limits, mapped_before);
  try {
    (void)reply(kept, read);
  } catch (...) {  // of a library; the parent sees that there is no whole reply
    ::_exit(1);
  }
  ::_exit(0);
}

// In the parent.

/// A forked child. It is gone, and no zombie, when this is.
class Child {
 public:
  explicit Child(pid_t pid) : pid_(pid) {}
  ~Child() { (void)end(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Whether it has died since.
  [[nodiscard]] bool is_gone() {
    if (pid_ > 0 && ::waitpid(pid_, nullptr, WNOHANG) == 0) return false;
    pid_ = 0;
    return true;
  }

  /// Kills it where it still runs. The signal it died of, or 0.
  int end() {
    if (pid_ <= 0) return 0;
    ::kill(pid_, SIGKILL);
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0) {
      if (errno != EINTR) break;
    }
    pid_ = 0;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t pid_;
};

/// Forks with signals blocked; the child does `body`, which does not return.
template <class Body>
pid_t forked(const fs::path& file, const Body& body) {
  const BlockedSignals blocked;
  const pid_t pid = ::fork();
  if (pid == 0) body();
  if (pid < 0) {
    throw Error("cannot be read in a process of its own: " + system_reason(errno), file.string());
  }
  return pid;
}

/// Thrown by `ReplyReader` when the child closes the connection before its reply is whole.
struct EndsEarly {};

/// Bytes from and to a child, as long as there is time and nobody asks to stop.
class ReplyReader {
 public:
  ReplyReader(int connection, const fs::path& file, const ChildLimits& limits)
      : connection_(connection),
        file_(file),
        limits_(limits),
        end_(SteadyClock::now() + std::chrono::duration_cast<SteadyClock::duration>(
                                      std::chrono::duration<double>(limits.seconds))) {}

  /// False when the child takes no more. @throws Error as `fill`
  [[nodiscard]] bool send(std::span<const std::byte> bytes) const {
    while (!bytes.empty()) {
      await(POLLOUT);
      const ssize_t n =
          ::send(connection_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n < 0 && errno != EINTR && errno != EAGAIN) return false;
      if (n > 0) bytes = bytes.subspan(n);
    }
    return true;
  }

  /// @throws EndsEarly, or Error after the time or on a stop
  void fill(std::span<std::byte> bytes) const {
    while (!bytes.empty()) {
      await(POLLIN);
      const ssize_t n = ::read(connection_, bytes.data(), bytes.size());
      if (n == 0 || (n < 0 && errno != EINTR)) throw EndsEarly();
      if (n > 0) bytes = bytes.subspan(n);
    }
  }

 private:
  void await(short event) const {
    for (;;) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(end_ - SteadyClock::now()).count();
      if (left <= 0) {
        throw Error("is damaged, or made to hang the library that reads it: not read after " +
                        std::to_string(std::lround(limits_.seconds)) + " s",
                    file_.string());
      }
      pollfd ready{connection_, event, 0};
      constexpr long long kLongestWait_ms = 100;
      if (::poll(&ready, 1, static_cast<int>(std::min<long long>(left, kLongestWait_ms))) > 0) {
        return;
      }
      if (limits_.stop_requested != nullptr && limits_.stop_requested()) {
        throw Error("was not read: stopped", file_.string());
      }
    }
  }

  int connection_;
  const fs::path& file_;
  const ChildLimits& limits_;
  SteadyClock::time_point end_;
};

Error needs_memory(const fs::path& file, const ChildLimits& limits) {
  return Error("is damaged, or made to exhaust the memory: reading it needs more than " +
                   std::to_string(limits.memory >> 20) + " MB",
               file.string());
}

/// Why a child ended without a whole reply.
Error early_end(int signal, const fs::path& file) {
  if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) {
    return Error("was not read: stopped", file.string());
  }
  return Error("is damaged, or made to crash the library that reads it" +
                   (signal == 0 ? std::string() : " (" + std::string(strsignal(signal)) + ")"),
               file.string());
}

std::vector<std::byte> receive(const ReplyReader& reader, const fs::path& file,
                               const ChildLimits& limits) {
  ReplyHeader header;
  reader.fill(std::as_writable_bytes(std::span(&header, 1)));
  if (header.kind == ReplyHeader::Kind::out_of_memory || header.size > limits.memory) {
    throw needs_memory(file, limits);
  }
  const bool is_error = header.kind == ReplyHeader::Kind::error;
  if (is_error && header.size > kLongestMessage) throw EndsEarly();
  std::vector<std::byte> bytes(header.size);
  reader.fill(bytes);
  if (is_error) throw Error(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  return bytes;
}

}  // namespace

std::vector<std::byte> read_in_child(const fs::path& file, const ChildLimits& limits,
                                     const std::function<std::vector<std::byte>()>& read) {
  Connection connection(file);
  const std::size_t mapped = mapped_bytes();
  const pid_t parent = ::getpid();
  Child child(forked(file, [&] { run_as_child(connection, parent, limits, mapped, read); }));
  connection.close_childs();
  try {
    return receive(ReplyReader(connection.ours(), file, limits), file, limits);
  } catch (const EndsEarly&) {
    throw early_end(child.end(), file);
  }
}

struct ParsingChild::Running {
  Running(const fs::path& file, Parse how)
      : connection(file), child(forked(file, [&, mapped = mapped_bytes()] {
          serve(begin_child(connection.childs(), parent), mapped, how);
        })) {
    connection.close_childs();
  }

  pid_t parent = ::getpid();
  Connection connection;
  Child child;
};

ParsingChild::ParsingChild(Parse how) : parse_(how) {}

ParsingChild::~ParsingChild() { leave_to_parent(); }

/// In a fork of the process whose child it is: neither ours to end, nor are its descriptors, whose
/// numbers may be others' by now.
void ParsingChild::leave_to_parent() {
  if (running_ && running_->parent != ::getpid()) (void)running_.release();
}

/// Makes sure of a child: since the last file it may have died, of Ctrl-C at a terminal.
void ParsingChild::start(const fs::path& file) {
  leave_to_parent();
  if (running_ && !running_->child.is_gone()) return;
  running_ = std::make_unique<Running>(file, parse_);
}

std::vector<std::byte> ParsingChild::parse(const fs::path& file, const ChildLimits& limits,
                                           const std::vector<std::byte>& request) {
  start(file);
  // Until its reply is whole and no error, this child is the last that is known of it.
  std::unique_ptr<Running> running = std::move(running_);
  const RequestHeader header{request.size(), limits.memory, limits.seconds};
  const ReplyReader reader(running->connection.ours(), file, limits);
  try {
    // A child that has no room for a request says so, and takes no more of it.
    const bool sent = reader.send(std::as_bytes(std::span(&header, 1))) && reader.send(request);
    std::vector<std::byte> bytes = receive(reader, file, limits);
    if (!sent) throw EndsEarly();
    running_ = std::move(running);
    return bytes;
  } catch (const EndsEarly&) {
    throw early_end(running->child.end(), file);
  }
}

}  // namespace geoprior
