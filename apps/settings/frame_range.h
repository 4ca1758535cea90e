#pragma once
// The frames of an animation, and the names of their files.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::apps {

/// Frames first, first + step, ... up to last.
struct FrameRange {
  int first = 0;
  int last = 0;
  int step = 1;  ///< negative: backwards
};

/// Frames in the order in which they are named. One that is named again counts at its first place.
struct FrameList {
  std::vector<FrameRange> ranges;  ///< at least one

  std::vector<int> numbers() const;
  int first() const { return ranges.front().first; }
  bool is_single() const;
};

/// The shutter of a frame, in frames from its time.
struct ShutterRange {
  double opens = 0.0;
  double closes = 0.0;

  bool is_open() const { return closes > opens; }
  double middle() const { return 0.5 * (opens + closes); }
};

struct FrameSettings {
  std::optional<FrameList> range;
  double fps = 24.0;  ///< frame n shows the time n / fps, with a shutter that of its middle
  int turntable = 0;  ///< frames of a whole turn of the camera; 0: it stays
  ShutterRange shutter;
  int groups = 1;  ///< of processes, each of which renders frames of its own

  bool any() const { return range || turntable > 0; }
  double seconds(double frame) const { return (frame + shutter.middle()) / fps; }
  double shutter_seconds() const { return (shutter.closes - shutter.opens) / fps; }
};

/// Reads "A", "A:B", "A-B" and either with ":STEP" or "xSTEP", and lists of these with commas. Throws
/// BadOption, which names the option.
FrameList parse_frames(const std::string& option, const std::string& text);
std::string text_of(const FrameList& frames);

/// Frames from each of them to the next, where that is the same for all; else 1.
int common_step(const std::vector<int>& frames);

/// Reads a number, or "30000/1001". Throws BadOption, which names the option.
double parse_fps(const std::string& option, const std::string& text);

/// Reads "OPEN:CLOSE". Throws BadOption, which names the option.
ShutterRange parse_shutter(const std::string& option, const std::string& text);
std::string text_of(const ShutterRange& shutter);

/// Whether the name, or that of a folder in it, holds the place of a frame's number: "%04d", "####" or
/// "{frame}". "%%" is a % and no place.
bool has_frame_place(std::string_view name);

/// For names of a single picture. Throws BadOption where the file's name holds such a place.
void refuse_frame_place(std::string_view option, const std::string& name);

/// For names of several frames. Throws BadOption where the name holds none.
void require_frame_place(std::string_view option, const std::string& name);

/// The name with the number in its places.
std::string name_of_frame(std::string_view name, int frame);

/// The name of a frame's file in the folder that must be there: without the folders that numbers name.
std::string name_in_given_folder(std::string_view name, int frame);

/// Makes the folders that the number names. A failure is left to who writes the file.
void make_folders_of_frame(std::string_view name, int frame);

}  // namespace gatelight::apps
