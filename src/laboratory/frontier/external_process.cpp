#include "frontier/external_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.h"

extern char** environ;

namespace lightgrid::lab {
namespace {

constexpr size_t max_heard = size_t(1) << 20;
constexpr double patience_s = 2;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void close_one(int& file) {
  if (file >= 0) close(file);
  file = -1;
}

// True if `file` is ready for `events` before that time.
bool is_ready(int file, short events, double until_s) {
  while (true) {
    const double left_ms = (until_s - now_s()) * 1000;
    if (left_ms <= 0) return false;
    pollfd entry{file, events, 0};
    const int found = poll(&entry, 1, int(std::min(left_ms, 1e9)) + 1);
    if (found > 0) return true;
    if (found < 0 && errno != EINTR) return false;
  }
}

std::string end_in_words(int status) {
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", WTERMSIG(status));
  return fmt::format("ended with status {}", WEXITSTATUS(status));
}

}  // namespace

ExternalProcess::ExternalProcess(std::vector<std::string> command, std::filesystem::path folder,
                                 double timeout_s)
    : command_(std::move(command)), folder_(std::move(folder)), timeout_s_(timeout_s) {}

ExternalProcess::~ExternalProcess() { stop(patience_s); }

// Its input is a socket, since writing to a pipe without a reader would end this program.
void ExternalProcess::start() {
  int input[2] = {-1, -1}, output[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) != 0 || pipe2(output, O_CLOEXEC) != 0) {
    const int code = errno;
    for (int* file : {&input[0], &input[1], &output[0], &output[1]}) close_one(*file);
    throw machine_error("{}: cannot be started: {}", command_.front(), strerror(code));
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder_.c_str());
  posix_spawn_file_actions_adddup2(&actions, input[1], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // its own group, with its children
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<char*> arguments;
  for (std::string& word : command_) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const int failure =
      posix_spawnp(&process_, arguments.front(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close_one(input[1]);
  close_one(output[1]);
  in_ = input[0];
  out_ = output[0];
  heard_.clear();
  answered_ = false;
  if (failure == 0) return;
  process_ = 0;
  close_one(in_);
  close_one(out_);
  throw machine_error("{}: cannot be started: {}", command_.front(), strerror(failure));
}

void ExternalProcess::stop(double patience) {
  close_one(in_);
  close_one(out_);
  if (process_ == 0) return;
  const double until_s = now_s() + patience;
  pid_t ended = 0;
  while ((ended = waitpid(process_, &status_, WNOHANG)) == 0 && now_s() < until_s)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(-process_, SIGKILL);  // and processes that it started and left behind
  while (ended == 0 && waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
}

// False if it has ended.
bool ExternalProcess::send(const std::string& line, double until_s) {
  for (size_t sent = 0; sent < line.size();) {
    if (!is_ready(in_, POLLOUT, until_s)) break;  // receive() tells that the time is over
    const ssize_t count = ::send(in_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) sent += size_t(count);
    if (count < 0 && errno != EINTR && errno != EAGAIN) return false;
  }
  return true;
}

// False if it has ended without one.
bool ExternalProcess::receive(std::string& answer, double until_s) {
  size_t heard = 0;
  while (true) {
    for (size_t end = heard_.find('\n'); end != std::string::npos; end = heard_.find('\n')) {
      answer = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      if (answer.starts_with("{")) return true;
    }
    if (!is_ready(out_, POLLIN, until_s)) {
      stop(0);
      throw machine_error("{}: no answer within {:g} s", command_.front(), timeout_s_);
    }
    char bytes[4096];
    const ssize_t count = read(out_, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {  // an answer may lack its newline
      answer = std::exchange(heard_, "");
      return answer.starts_with("{");
    }
    heard_.append(bytes, size_t(count));
    heard += size_t(count);
    if (heard > max_heard) {
      stop(0);
      throw machine_error("{}: says more than 1 MiB without an answer", command_.front());
    }
  }
}

std::string ExternalProcess::ask(const std::string& line) {
  const double until_s = now_s() + timeout_s_;
  while (true) {
    if (process_ == 0) start();
    const bool may_have_ended = answered_;
    std::string answer;
    if (send(line + "\n", until_s) && receive(answer, until_s)) {
      answered_ = true;
      return answer;
    }
    stop(patience_s);
    if (!may_have_ended)
      throw machine_error("{}: {} without an answer", command_.front(), end_in_words(status_));
  }
}

}  // namespace lightgrid::lab
