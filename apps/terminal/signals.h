#pragma once
// SIGINT, SIGTERM and SIGHUP ask for the end, SIGUSR1 for a snapshot. The handlers only set flags.

namespace gatelight::apps {

/// A second signal of the same kind finds the system's handler again and ends the program at once. SIGHUP
/// stays ignored where it was (nohup); SIGINT does not: shells ignore it for what they start in the
/// background, where it is sent on purpose.
void install_signal_handlers();

/// What cannot be written (a pipe whose reader is gone, a file at its limit of size) is an error, as on a
/// full disk, and no reason to be killed and lose a picture.
void ignore_write_signals();

/// The first signal that asked for the end; 0: none.
int stop_signal();

/// Whether a snapshot was asked for since the last call.
bool take_snapshot_request();

}  // namespace gatelight::apps
