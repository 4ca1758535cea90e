#include "apps/live/live_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "apps/live/tev_packets.h"

namespace gatelight::apps {
namespace {

constexpr double kSeconds = 1.0;
constexpr double kShare = 0.1;
constexpr std::size_t kPacketBytes = 1 << 20;

}  // namespace

void LiveDisplay::show(const std::string& name, const renderer::Picture& picture, Clock::time_point started) {
  try {
    send(name, picture);
  } catch (const std::runtime_error& error) {
    sender_.reset();
    warn_(fmt::format("--live: {} takes no picture ({}); the render goes on", address_.text(), error.what()));
  }
  const double pause = std::max(kSeconds, seconds_since(started) / kShare);
  next_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(pause));
}

void LiveDisplay::send(const std::string& name, const renderer::Picture& picture) {
  if (!sender_) {
    shown_.clear();
    sender_ = std::make_unique<TcpSender>(address_);
  }
  const std::string image = tev_create_image(name, picture);
  if (image != shown_) sender_->send(image);
  shown_ = image;
  for (const renderer::Layer& layer : picture.layers) {
    const std::size_t row = sizeof(float) * static_cast<std::size_t>(picture.width) * layer.channels.size();
    const int rows = static_cast<int>(std::max<std::size_t>(1, kPacketBytes / row));
    for (int begin = 0; begin < picture.height; begin += rows)
      sender_->send(tev_update_image(name, picture, layer, begin, std::min(begin + rows, picture.height)));
  }
}

}  // namespace gatelight::apps
