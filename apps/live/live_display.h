#pragma once
// Shows pictures that are being made in the image viewer tev.

#include <functional>
#include <memory>
#include <string>

#include "apps/live/network_address.h"
#include "apps/live/tcp_sender.h"
#include "base/clock.h"
#include "renderer/image/picture.h"

namespace gatelight::apps {

class LiveDisplay {
 public:
  using Warn = std::function<void(const std::string&)>;

  /// A viewer that does not answer costs a warning, and is tried again.
  LiveDisplay(NetworkAddress address, Warn warn) : address_(std::move(address)), warn_(std::move(warn)) {}

  /// Whether an unfinished picture is due: a second after the last one, or as much later as keeps the cost of
  /// showing below a tenth of the time.
  bool is_due() const { return Clock::now() >= next_; }
  /// `started`: when the picture was begun to be made for this, which is a part of its cost.
  void show(const std::string& name, const renderer::Picture& picture, Clock::time_point started);

 private:
  void send(const std::string& name, const renderer::Picture& picture);

  const NetworkAddress address_;
  const Warn warn_;
  std::unique_ptr<TcpSender> sender_;
  std::string shown_;  ///< what created the image that tev has
  Clock::time_point next_ = Clock::now();
};

}  // namespace gatelight::apps
