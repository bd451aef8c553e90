// A library to preload (LD_PRELOAD): makes one call of the system fail, as SQLite's tests do.
//   FAULT_KIND   new, file, thread or process: what is counted, see below
//   FAULT_AT     the number of the call that fails, from 1; 0: none, they are counted only
//   FAULT_LASTS  set: all calls after it fail, too
//   FAULT_COUNT  a file that gets the number of calls at the end, and how many of them were before writing
//   FAULT_FORKS  set: of the kind `new`, each call fails in turn in a child that is forked there, until the
//                program makes its second temporary folder; FAULT_COUNT gets the number of calls tried and,
//                as lines, those after which the child ended wrongly
// The kind `file` fails with no space on the device.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

constexpr int right_end = 5;  // the exit code when a budget is hit

struct Plan {
  const char* kind = std::getenv("FAULT_KIND");
  long at = std::getenv("FAULT_AT") != nullptr ? std::atol(std::getenv("FAULT_AT")) : 0;
  bool lasts = std::getenv("FAULT_LASTS") != nullptr, forks = std::getenv("FAULT_FORKS") != nullptr;
  const char* count_file = std::getenv("FAULT_COUNT");
  pid_t process = getpid();
};

Plan& plan() {
  static Plan known;
  return known;
}

std::atomic<long> calls{0};
std::atomic<long> wrong{0};
std::atomic<int> folders{0};
std::atomic<long> before_writing{0};  // number of calls before the program makes its second temporary folder

void write_number(int file, const char* what, long number) {
  char text[64];
  const int length = std::snprintf(text, sizeof text, "%s%ld\n", what, number);
  if (write(file, text, static_cast<std::size_t>(length)) < 0) return;
}

/// Fails at this call in a forked child, which must then end properly by itself.
bool fails_in_a_child(long call) {
  const pid_t child = fork();
  if (child == 0) return true;
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return false;
  if (WIFEXITED(status) && WEXITSTATUS(status) == right_end) return false;
  wrong.fetch_add(1);
  const int file = open(plan().count_file, O_WRONLY | O_CREAT | O_APPEND, 0644);
  write_number(file, WIFSIGNALED(status) ? "signal at call " : "wrong exit code at call ", call);
  close(file);
  return false;
}

bool is_kind(const char* kind) { return plan().kind != nullptr && std::strcmp(plan().kind, kind) == 0; }

thread_local bool inside = false;

bool fails(const char* kind) {
  if (inside || !is_kind(kind)) return false;
  inside = true;
  const long call = calls.fetch_add(1) + 1;
  bool failing = !plan().forks && plan().at > 0 && (call == plan().at || (plan().lasts && call > plan().at));
  if (plan().forks && folders.load() < 2 && call >= plan().at && getpid() == plan().process)
    failing = fails_in_a_child(call);
  inside = false;
  return failing;
}

/// If the program works in a child, faults happen in that child.
void follow_child() {
  if (inside) return;
  plan().process = getpid();
  calls.store(0);
  folders.store(0);
}

struct Report {
  Report() { pthread_atfork(nullptr, nullptr, follow_child); }
  ~Report() {
    if (plan().count_file == nullptr || getpid() != plan().process) return;
    inside = true;
    const int file = open(plan().count_file, O_WRONLY | O_CREAT | O_APPEND, 0644);
    write_number(file, "calls ", calls.load());
    write_number(file, "before_writing ", before_writing.load());
    close(file);
  }
} report;

template <class Function>
Function next(Function, const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

int no_space() {
  errno = ENOSPC;
  return -1;
}

// Allocates as operator new does when memory is short.
void* allocate(std::size_t bytes, std::size_t alignment) {
  while (true) {
    // Libraries allocate while they are loaded, before the program can react.
    if (std::get_new_handler() == nullptr || !fails("new")) {
      void* const block =
          alignment == 0 ? std::malloc(bytes == 0 ? 1 : bytes)
                         : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
      if (block != nullptr) return block;
    }
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

}  // namespace

void* operator new(std::size_t bytes) { return allocate(bytes, 0); }
void* operator new[](std::size_t bytes) { return allocate(bytes, 0); }
void* operator new(std::size_t bytes, std::align_val_t a) {
  return allocate(bytes, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t bytes, std::align_val_t a) {
  return allocate(bytes, static_cast<std::size_t>(a));
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }

extern "C" {

int mkdir(const char* name, mode_t mode) {
  static const auto real = next(mkdir, "mkdir");
  if (std::strstr(name, "/.collarmesh-") != nullptr && folders.fetch_add(1) == 1)
    before_writing.store(calls.load());
  if (fails("file")) return no_space();
  return real(name, mode);
}
std::size_t fwrite(const void* data, std::size_t size, std::size_t count, FILE* file) {
  static const auto real = next(fwrite, "fwrite");
  if (file != stderr && fails("file")) return no_space(), 0;
  return real(data, size, count, file);
}
int fclose(FILE* file) {
  static const auto real = next(fclose, "fclose");
  const bool failing = fails("file");
  const int result = real(file);
  return failing ? no_space() : result;
}
ssize_t write(int file, const void* data, std::size_t bytes) {
  static const auto real = next(write, "write");
  if (file != STDERR_FILENO && fails("file")) return no_space();
  return real(file, data, bytes);
}
ssize_t pwrite(int file, const void* data, std::size_t bytes, off_t offset) {
  static const auto real = next(pwrite, "pwrite");
  if (fails("file")) return no_space();
  return real(file, data, bytes, offset);
}
ssize_t pwrite64(int file, const void* data, std::size_t bytes, off64_t offset) {
  static const auto real = next(pwrite64, "pwrite64");
  if (fails("file")) return no_space();
  return real(file, data, bytes, offset);
}
int fsync(int file) {
  static const auto real = next(fsync, "fsync");
  if (fails("file")) return no_space();
  return real(file);
}
int ftruncate64(int file, off64_t length) {
  static const auto real = next(ftruncate64, "ftruncate64");
  if (fails("file")) return no_space();
  return real(file, length);
}
int rename(const char* from, const char* to) {
  static const auto real = next(rename, "rename");
  if (fails("file")) return no_space();
  return real(from, to);
}
int link(const char* from, const char* to) {
  static const auto real = next(link, "link");
  if (fails("file")) return no_space();
  return real(from, to);
}
int chmod(const char* path, mode_t mode) {
  static const auto real = next(chmod, "chmod");
  if (fails("file")) return no_space();
  return real(path, mode);
}
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
                   void* argument) {
  static const auto real = next(pthread_create, "pthread_create");
  if (fails("thread")) return EAGAIN;
  return real(thread, attributes, function, argument);
}
}
