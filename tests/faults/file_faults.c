/* Makes file operations fail: preloaded into a process, it counts what would change files below a
 * folder, and at the chosen one kills the process or, from there on, lets the disk be full.
 *
 * FAULT_FOLDER  absolute path; only files below it count
 * FAULT_AT      number of the operation, from 1; 0: none
 * FAULT_KIND    kill: SIGKILL before the operation; full: it and all later ones give ENOSPC
 * FAULT_COUNT   file into which the number of operations is written when the process ends
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static int operations;

static int is_below(const char* path) {
  const char* folder = getenv("FAULT_FOLDER");
  return folder != NULL && path != NULL && strncmp(path, folder, strlen(folder)) == 0;
}

static int is_file_below(int file) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length < 0) return 0;
  path[length] = '\0';
  return is_below(path);
}

static int is_below_folder(int folder, const char* path) {
  return path[0] == '/' || folder == AT_FDCWD ? is_below(path) : is_file_below(folder);
}

/* Counts an operation; returns whether it must fail. */
static int fails(void) {
  const char* at = getenv("FAULT_AT");
  const int chosen = at != NULL ? atoi(at) : 0;
  const int now = __atomic_add_fetch(&operations, 1, __ATOMIC_SEQ_CST);
  if (chosen == 0 || now < chosen) return 0;
  const char* kind = getenv("FAULT_KIND");
  if (kind != NULL && strcmp(kind, "kill") == 0) kill(getpid(), SIGKILL);
  errno = ENOSPC;
  return 1;
}

__attribute__((destructor)) static void tell(void) {
  const char* name = getenv("FAULT_COUNT");
  if (name == NULL) return;
  char text[32];
  const int length = snprintf(text, sizeof text, "%d", operations);
  const int file = REAL(open)(name, O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || REAL(write)(file, text, length) != length) abort();
}

static int changes(int flags) { return (flags & (O_CREAT | O_TRUNC)) != 0; }

#define OPENS(name)                                              \
  int name(const char* path, int flags, ...) {                   \
    va_list more;                                                \
    va_start(more, flags);                                       \
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0; \
    va_end(more);                                                \
    if (changes(flags) && is_below(path) && fails()) return -1;  \
    return REAL(name)(path, flags, mode);                        \
  }
OPENS(open)
OPENS(open64)

#define OPENS_AT(name)                                                           \
  int name(int folder, const char* path, int flags, ...) {                       \
    va_list more;                                                                \
    va_start(more, flags);                                                       \
    const mode_t mode = flags & O_CREAT ? va_arg(more, mode_t) : 0;              \
    va_end(more);                                                                \
    if (changes(flags) && is_below_folder(folder, path) && fails()) return -1;   \
    return REAL(name)(folder, path, flags, mode);                                \
  }
OPENS_AT(openat)
OPENS_AT(openat64)

#define FOPENS(name)                                                            \
  FILE* name(const char* path, const char* mode) {                              \
    if (strpbrk(mode, "wa") != NULL && is_below(path) && fails()) return NULL;  \
    return REAL(name)(path, mode);                                              \
  }
FOPENS(fopen)
FOPENS(fopen64)

ssize_t write(int file, const void* data, size_t size) {
  if (is_file_below(file) && fails()) return -1;
  return REAL(write)(file, data, size);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  if (is_file_below(file) && fails()) return -1;
  return REAL(writev)(file, parts, count);
}

#define PWRITES(name, Offset)                                               \
  ssize_t name(int file, const void* data, size_t size, Offset offset) {    \
    if (is_file_below(file) && fails()) return -1;                          \
    return REAL(name)(file, data, size, offset);                            \
  }
PWRITES(pwrite, off_t)
PWRITES(pwrite64, off64_t)

#define RENAMES(name)                                                 \
  int name(const char* from, const char* to) {                        \
    if ((is_below(from) || is_below(to)) && fails()) return -1;       \
    return REAL(name)(from, to);                                      \
  }
RENAMES(rename)
RENAMES(link)

int mkdir(const char* path, mode_t mode) {
  if (is_below(path) && fails()) return -1;
  return REAL(mkdir)(path, mode);
}

int fsync(int file) {
  if (is_file_below(file) && fails()) return -1;
  return REAL(fsync)(file);
}

/* A full disk lets files be removed; a kill can come before that, too. */
#define REMOVES(name, ...)                          \
  const char* kind = getenv("FAULT_KIND");          \
  if (kind != NULL && strcmp(kind, "kill") == 0) fails(); \
  return REAL(name)(__VA_ARGS__);

int unlink(const char* path) {
  if (!is_below(path)) return REAL(unlink)(path);
  REMOVES(unlink, path)
}

int rmdir(const char* path) {
  if (!is_below(path)) return REAL(rmdir)(path);
  REMOVES(rmdir, path)
}

int unlinkat(int folder, const char* path, int flags) {
  if (!is_below_folder(folder, path)) return REAL(unlinkat)(folder, path, flags);
  REMOVES(unlinkat, folder, path, flags)
}
