#include "end_signal.h"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace blem_sim {

namespace {

std::atomic<int> signal_that_came{0};

void take(int number) { signal_that_came = number; }

/** Signals that the program was started to ignore, as in a shell's background, stay ignored. */
void handle(void (*handler)(int)) {
  struct sigaction action = {}, before = {};
  action.sa_handler = handler;
  action.sa_flags = handler == SIG_DFL ? 0 : static_cast<int>(SA_RESETHAND | SA_RESTART);
  for (const int number : {SIGINT, SIGTERM}) {
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);
  }
}

}  // namespace

EndSignal::EndSignal() {
  signal_that_came = 0;
  handle(take);
}

EndSignal::~EndSignal() { handle(SIG_DFL); }

int EndSignal::number() const { return signal_that_came; }

const char* EndSignal::name() const { return number() == SIGINT ? "SIGINT" : number() == SIGTERM ? "SIGTERM" : ""; }

void EndSignal::passOn() const {
  if (number() == 0) return;
  handle(SIG_DFL);
  raise(number());
}

}  // namespace blem_sim
