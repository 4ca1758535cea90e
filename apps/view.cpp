#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <memory>
#include <thread>

#include "apps/settings/flags.h"
#include "apps/settings/option_table.h"
#include "apps/settings/picture_output.h"
#include "apps/subcommand.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "apps/view/picture_file.h"
#include "apps/view/view_api.h"
#include "apps/view/view_session.h"

namespace gatelight::apps {
namespace {

constexpr const char* kViewFooter =
    R"(Opens a page in the browser on this machine. It shows the scene and, while nothing changes, refines the picture until it
equals that of `gatelight render` with the same flags (with --preset final, unless a preset or an integrator is given).
Finished pictures are shown in the same page. Drag to turn the view; "?" lists the keys. The page saves EXR and
PNG, and copies the command of the picture. The server answers only this machine, and only under the printed address.

Examples:
  gatelight view room.glb
  gatelight view room.glb --size 1280x720 --preset standard
  gatelight view room.exr
  gatelight view house.glb --sky "sun=200,30" --port 8000 --no-browser)";

constexpr auto kPoll = std::chrono::milliseconds(100);

/// Whether a flag of `render` makes sense for a picture in a window. As in a sweep, files, frames and limits
/// do not.
bool is_of_window(const Option& option) {
  if (option.name == "region" || option.name == "view-file") return false;
  return option.marks.in_sweep || option.marks.stage == OptionStage::output || option.name == "aov";
}

struct WindowSettings {
  RenderSettings render;
  int port = 0;
  bool no_browser = false;
};

std::vector<Option> window_options(WindowSettings& window) {
  std::vector<Option> table = option_table(window.render);
  std::erase_if(table, [](const Option& option) { return !is_of_window(option); });
  for (Option& option : table) {
    if (option.positional) option.help = "Scene (.gltf, .glb) or finished picture";
  }
  OptionGroup group{table, "Window"};
  group.add(number("port", window.port, {0, 65535}, "N", "Port of the server; 0: any free port"),
            {.common = true});
  group.add(toggle("no-browser", window.no_browser, "Print the address without opening a browser"),
            {.common = true});
  return table;
}

/// The scene or the picture.
std::unique_ptr<PictureSource> open_source(const WindowSettings& window) {
  const std::string& file = window.render.scene;
  std::vector<std::string> words = given_words(window.render);
  const std::set<std::string>& given = window.render.given;
  if (is_picture(file)) {
    if (!given.contains("exposure")) words.emplace_back("--exposure=auto");
    return std::make_unique<PictureFile>(file, std::move(words));
  }
  if (!given.contains("preset") && !given.contains("integrator"))
    words.insert(words.begin(), "--preset=final");
  auto session = std::make_unique<ViewSession>(file, std::move(words));
  for (const std::string& warning : session->warnings()) log_warning(warning);
  return session;
}

/// Opens an address in the desktop's browser, where there are a desktop and `xdg-open`. Does not wait.
void open_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return;
  posix_spawn_file_actions_t files;
  if (posix_spawn_file_actions_init(&files) != 0) return;
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
  std::string program = "xdg-open", argument = address;
  char* const words[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), &files, nullptr, words, environ) == 0)
    std::thread([child] { waitpid(child, nullptr, 0); }).detach();
  posix_spawn_file_actions_destroy(&files);
}

int run_view(const WindowSettings& window) {
  install_signal_handlers();
  const std::unique_ptr<PictureSource> source = open_source(window);
  ViewApi api(*source);
  WebServer server(window.port, [&api](const WebRequest& request) { return api.answer(request); });
  print_status(fmt::format("{}\n", server.address()));
  if (!window.no_browser) open_browser(server.address());
  std::jthread watch([&](const std::stop_token& over) {
    while (!over.stop_requested() && stop_signal() == 0) std::this_thread::sleep_for(kPoll);
    source->stop();
    server.stop();
  });
  server.serve();
  watch.request_stop();
  const int signal = stop_signal();
  return signal == 0 ? kDone : kSignalBase + signal;
}

}  // namespace

Subcommand add_view_command(CLI::App& root) {
  CLI::App* app =
      add_subcommand(root, "view", "Show a scene in the browser and change its view and light", kViewFooter);
  const auto window = std::make_shared<WindowSettings>();
  const std::vector<Option> options = window_options(*window);
  add_flags(*app, options);
  return {app,
          [app, window] {
            finish_flags(*app, window->render);
            return run_view(*window);
          },
          common_names(options)};
}

}  // namespace gatelight::apps
