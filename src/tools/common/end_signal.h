// SIGINT and SIGTERM as a question, so that a program ends where its files are whole.
#pragma once

namespace blem_sim {

/** Takes both signals while it lives. A second one of the same kind ends the program at once. One at a time. */
class EndSignal {
 public:
  EndSignal();
  ~EndSignal();
  EndSignal(const EndSignal&) = delete;
  EndSignal& operator=(const EndSignal&) = delete;

  /** Number of the signal that came, or 0. */
  int number() const;
  /** "SIGINT", "SIGTERM" or "". */
  const char* name() const;
  /** Ends the program by the signal that came, as if it had not been taken; without one it does nothing. */
  void passOn() const;
};

}  // namespace blem_sim
