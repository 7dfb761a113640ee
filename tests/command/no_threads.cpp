// Put before the C library (LD_PRELOAD): the system has no thread to give.
#include <pthread.h>

#include <cerrno>

extern "C" int pthread_create(pthread_t* /*unused*/, const pthread_attr_t* /*unused*/,
                              void* (* /*unused*/)(void*), void* /*unused*/) {
  return EAGAIN;
}
