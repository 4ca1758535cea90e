#pragma once
// SIGINT, SIGTERM and SIGHUP request the end, SIGUSR1 a snapshot. The handlers only set flags.

namespace gatelight::apps {

/// A second signal of the same kind gets the system's handler, which ends the program at once. SIGHUP stays
/// ignored where it was (nohup). SIGINT does not: shells ignore it for background jobs, to which it is sent
/// on purpose.
void install_signal_handlers();

/// Ignores SIGPIPE and SIGXFSZ. A pipe without a reader or a file at its size limit is then a write error,
/// and does not kill the program.
void ignore_write_signals();

/// Requests the end as this signal does.
void request_stop(int signal);

/// The first signal that requested the end; 0: none.
int stop_signal();

/// Whether a snapshot was requested since the last call.
bool take_snapshot_request();

}  // namespace gatelight::apps
