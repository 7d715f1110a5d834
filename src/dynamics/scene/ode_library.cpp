#include "scene/ode_library.h"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <mutex>

namespace blem_sim::dynamics {
namespace {

thread_local int lcp_errors = 0;

struct Handlers {
  dMessageFunction *message = nullptr, *error = nullptr, *debug = nullptr;
};

struct Usage {
  std::mutex mutex;
  int users = 0;
  Handlers previous;
};

Usage& usage() {
  static Usage instance;
  return instance;
}

void onMessage(int number, const char*, va_list) {
  if (number == d_ERR_LCP) ++lcp_errors;
}

// ODE exits or aborts when its error handlers return, so they do not.
void onFailure(int, const char* format, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  throw OdeFailure(text);
}

}  // namespace

OdeLibrary::OdeLibrary() {
  Usage& u = usage();
  const std::lock_guard<std::mutex> lock(u.mutex);
  if (u.users++ > 0) return;
  dInitODE2(0);
  u.previous = {dGetMessageHandler(), dGetErrorHandler(), dGetDebugHandler()};
  dSetMessageHandler(onMessage);
  dSetErrorHandler(onFailure);
  dSetDebugHandler(onFailure);
}

OdeLibrary::~OdeLibrary() {
  Usage& u = usage();
  const std::lock_guard<std::mutex> lock(u.mutex);
  if (--u.users > 0) return;
  dSetMessageHandler(u.previous.message);
  dSetErrorHandler(u.previous.error);
  dSetDebugHandler(u.previous.debug);
  dCloseODE();
}

int OdeLibrary::takeLcpErrors() {
  const int count = lcp_errors;
  lcp_errors = 0;
  return count;
}

}  // namespace blem_sim::dynamics
