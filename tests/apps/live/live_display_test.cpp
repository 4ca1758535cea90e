// Pictures in tev: a server that reads its protocol as tev's README describes it.

#include "apps/live/live_display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "apps/live/tev_packets.h"
#include "base/errors.h"
#include "renderer/image/image_read.h"
#include "tests/apps/render_command.h"

namespace gatelight::tests {
namespace {

using apps::LiveDisplay;
using apps::NetworkAddress;
using apps::parse_network_address;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Reads a packet's values in order.
class Reader {
 public:
  explicit Reader(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class Value>
  Value take() {
    Value value{};
    if (at_ + sizeof value > bytes_.size()) throw std::runtime_error("a packet ends early");
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text() {
    const std::size_t end = bytes_.find('\0', at_);
    if (end == std::string::npos) throw std::runtime_error("a text has no end");
    const std::string result = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    return result;
  }
  std::vector<std::string> texts(int count) {
    std::vector<std::string> result;
    for (int i = 0; i < count; ++i) result.push_back(text());
    return result;
  }
  bool is_empty() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::string> names;
  std::map<std::string, std::vector<float>> channels;
};

/// What a viewer would show.
struct Viewer {
  std::map<std::string, Image> images;
  int creations = 0, updates = 0;

  void create(Reader& packet) {
    ++creations;
    EXPECT_EQ(packet.take<std::uint8_t>(), 1);
    Image& image = images[packet.text()];
    image = {};
    image.width = packet.take<std::int32_t>();
    image.height = packet.take<std::int32_t>();
    image.names = packet.texts(packet.take<std::int32_t>());
    for (const std::string& name : image.names)
      image.channels[name].assign(static_cast<std::size_t>(image.width * image.height), -1.0f);
  }

  void update(Reader& packet) {
    ++updates;
    EXPECT_EQ(packet.take<std::uint8_t>(), 0);
    Image& image = images.at(packet.text());
    const std::vector<std::string> names = packet.texts(packet.take<std::int32_t>());
    const int x0 = packet.take<std::int32_t>(), y0 = packet.take<std::int32_t>();
    const int width = packet.take<std::int32_t>(), height = packet.take<std::int32_t>();
    std::vector<std::int64_t> offsets, strides;
    for (std::size_t c = 0; c < names.size(); ++c) offsets.push_back(packet.take<std::int64_t>());
    for (std::size_t c = 0; c < names.size(); ++c) strides.push_back(packet.take<std::int64_t>());
    std::vector<float> data;
    while (!packet.is_empty()) data.push_back(packet.take<float>());
    for (std::size_t c = 0; c < names.size(); ++c) {
      for (int i = 0; i < width * height; ++i) {
        const int x = x0 + i % width, y = y0 + i / width;
        image.channels.at(names[c]).at(static_cast<std::size_t>(y * image.width + x)) =
            data.at(static_cast<std::size_t>(offsets[c] + i * strides[c]));
      }
    }
  }

  void take(std::string bytes) {
    Reader packet(std::move(bytes));
    const auto operation = packet.take<std::uint8_t>();
    if (operation == 4) {
      create(packet);
    } else if (operation == 6) {
      update(packet);
    } else {
      ADD_FAILURE() << "operation " << int(operation);
    }
    EXPECT_TRUE(packet.is_empty());
  }
};

/// Takes so many connections, one after the other.
class Server {
 public:
  /// `port` 0: a free one.
  explicit Server(int connections = 1, int port = 0) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    socklen_t size = sizeof address;
    const int yes = 1;
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(socket_, 4) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("no server");
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this, connections] {
      for (int i = 0; i < connections; ++i) serve(accept(socket_, nullptr, nullptr));
    });
  }
  ~Server() {
    shutdown(socket_, SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    close(socket_);
  }

  int port() const { return port_; }
  std::string text() const { return "127.0.0.1:" + std::to_string(port_); }
  /// After all connections were made and closed.
  const Viewer& finish() {
    thread_.join();
    return viewer_;
  }

 private:
  static bool read_all(int from, char* bytes, std::size_t size) {
    while (size > 0) {
      const ssize_t count = read(from, bytes, size);
      if (count <= 0) return false;
      bytes += count;
      size -= static_cast<std::size_t>(count);
    }
    return true;
  }

  void serve(int connection) {
    if (connection < 0) return;
    std::uint32_t size = 0;
    while (read_all(connection, reinterpret_cast<char*>(&size), sizeof size)) {
      std::string bytes(size - sizeof size, '\0');
      if (!read_all(connection, bytes.data(), bytes.size())) break;
      viewer_.take(std::move(bytes));
    }
    close(connection);
  }

  int socket_;
  int port_ = 0;
  Viewer viewer_;
  std::thread thread_;
};

renderer::Picture picture_of(int width, int height, float first) {
  renderer::Picture picture{.width = width, .height = height};
  picture.layers = {{.name = "", .channels = {"R", "G", "B"}}, {.name = "depth", .channels = {"Z"}}};
  for (renderer::Layer& layer : picture.layers) {
    layer.values.resize(static_cast<std::size_t>(width * height) * layer.channels.size());
    for (float& value : layer.values) value = first++;
  }
  return picture;
}

TEST(TevPackets, HaveTheBytesOfTheProtocol) {
  const renderer::Picture picture = picture_of(1, 1, 1.0f);
  EXPECT_EQ(apps::tev_create_image("a", picture),
            std::string("\x22\0\0\0\x04\x01"
                        "a\0\x01\0\0\0\x01\0\0\0\x04\0\0\0R\0G\0B\0depth.Z\0",
                        34));
  const std::string update = apps::tev_update_image("a", picture, picture.layers[1], 0, 1);
  EXPECT_EQ(update, std::string("\x38\0\0\0\x06\0"
                                "a\0\x01\0\0\0depth.Z\0\0\0\0\0\0\0\0\0\x01\0\0\0\x01\0\0\0"
                                "\0\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\0\0\0\x80\x40",
                                56));
}

TEST(LiveDisplay, SendsAllLayersInParts) {
  Server server;
  const renderer::Picture first = picture_of(300, 700, 0.0f), second = picture_of(300, 700, 7.0f);
  std::vector<std::string> warnings;
  {
    LiveDisplay display({"127.0.0.1", server.port()},
                        [&](const std::string& text) { warnings.push_back(text); });
    EXPECT_TRUE(display.is_due());
    display.show("room.exr", first, Clock::now());
    EXPECT_FALSE(display.is_due());
    display.show("room.exr", second, Clock::now());
  }
  const Viewer& viewer = server.finish();
  EXPECT_THAT(warnings, IsEmpty());
  EXPECT_EQ(viewer.creations, 1);
  EXPECT_GT(viewer.updates, 4);
  const Image& image = viewer.images.at("room.exr");
  EXPECT_THAT(image.names, ElementsAre("R", "G", "B", "depth.Z"));
  for (std::size_t i = 0; i < 300 * 700; ++i) {
    ASSERT_EQ(image.channels.at("G")[i], second.layers[0].values[3 * i + 1]);
    ASSERT_EQ(image.channels.at("depth.Z")[i], second.layers[1].values[i]);
  }
}

TEST(LiveDisplay, CreatesAnImageAnewWhereItsChannelsChange) {
  Server server;
  {
    LiveDisplay display({"127.0.0.1", server.port()}, [](const std::string& text) { ADD_FAILURE() << text; });
    renderer::Picture picture = picture_of(4, 3, 0.0f);
    display.show("a", picture, Clock::now());
    picture.layers.pop_back();
    display.show("a", picture, Clock::now());
    // A part of a larger picture.
    picture.full_width = 10;
    picture.full_height = 8;
    picture.x0 = 6;
    picture.y0 = 5;
    display.show("a", picture, Clock::now());
  }
  const Viewer& viewer = server.finish();
  EXPECT_EQ(viewer.creations, 3);
  const Image& image = viewer.images.at("a");
  EXPECT_EQ(image.width, 10);
  EXPECT_EQ(image.channels.at("R")[5 * 10 + 6], 0.0f);
  EXPECT_EQ(image.channels.at("R")[0], -1.0f);
}

TEST(LiveDisplay, TriesAgainAfterAFailure) {
  std::vector<std::string> warnings;
  const int port = Server(0).port();
  auto display = std::make_unique<LiveDisplay>(NetworkAddress{"127.0.0.1", port},
                                               [&](const std::string& text) { warnings.push_back(text); });
  display->show("a", picture_of(4, 3, 0.0f), Clock::now());
  ASSERT_THAT(warnings, SizeIs(1));
  EXPECT_THAT(warnings[0], HasSubstr("127.0.0.1:" + std::to_string(port) + " takes no picture"));
  Server server(1, port);
  display->show("a", picture_of(4, 3, 5.0f), Clock::now());
  display.reset();
  EXPECT_EQ(server.finish().images.at("a").channels.at("R")[0], 5.0f);
  EXPECT_THAT(warnings, SizeIs(1));
}

TEST(NetworkAddress, IsReadOrRefused) {
  const auto read = [](const std::string& text) {
    return parse_network_address("--live", text, 14158).text();
  };
  EXPECT_EQ(read("localhost"), "localhost:14158");
  EXPECT_EQ(read("10.0.0.2:80"), "10.0.0.2:80");
  EXPECT_EQ(read("[::1]:90"), "[::1]:90");
  EXPECT_EQ(read("[fe80::1%eth0]"), "[fe80::1%eth0]:14158");
  for (const char* wrong :
       {"", ":", ":80", "a:", "a:0", "a:65536", "a:b", "a b", "[::1", "[]:80", "::1", "a/b:80"})
    EXPECT_THROW(read(wrong), BadOption) << wrong;
}

class LiveRender : public SquareRenders {};

TEST_F(LiveRender, ShowsThePictureOfTheFile) {
  Server server;
  const Output output =
      render({"-o", path("a.exr"), "--exr", "float", "--aov", "depth", "--live", server.text()});
  ASSERT_EQ(output.exit_code, 0) << output.err;
  EXPECT_THAT(output.warnings(), IsEmpty());
  const Viewer& viewer = server.finish();
  const renderer::Picture picture = renderer::read_image(path("a.exr"));
  const Image& image = viewer.images.at(path("a.exr"));
  ASSERT_EQ(image.width, picture.width);
  for (const renderer::Layer& layer : picture.layers) {
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
      const std::vector<float>& shown = image.channels.at(apps::tev_channel(layer, c));
      for (std::size_t i = 0; i < shown.size(); ++i)
        ASSERT_EQ(shown[i], layer.values[i * layer.channels.size() + c]);
    }
  }
}

TEST_F(LiveRender, GoesOnWithoutAViewer) {
  const int port = Server(0).port();
  ASSERT_EQ(render({"-o", path("a.exr"), "--reproducible"}).exit_code, 0);
  const Output output =
      render({"-o", path("b.exr"), "--reproducible", "--live", "127.0.0.1:" + std::to_string(port)});
  EXPECT_EQ(output.exit_code, 0);
  EXPECT_THAT(output.warnings(), SizeIs(1));
  EXPECT_EQ(read_file(path("a.exr")), read_file(path("b.exr")));
}

TEST_F(LiveRender, RefusesAnAddressBeforeItRenders) {
  expect_failure_names(render({"-o", path("a.exr"), "--live", "here:now"}), 1, {"--live", "now"});
}

}  // namespace
}  // namespace gatelight::tests
