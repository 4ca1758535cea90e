"""The render engine: exports, starts the program, shows its pictures as they grow, and fills Blender's passes."""

import os
import shutil
import tempfile
import time

import bpy

from . import animation, exr, find_program, flags, main_thread, passes, preferences, report, run, sequence
from .export import Unusable, export

POLL = 0.05  # seconds between two looks at the program
FIRST_SNAPSHOT, SLOWEST_SNAPSHOT = 1.0, 15.0  # seconds; in between the wait doubles


class GatelightEngine(bpy.types.RenderEngine):
    bl_idname = "GATELIGHT"
    bl_label = "Gatelight"
    bl_use_preview = False
    bl_use_postprocess = True
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False  # the shader editor offers the nodes of Cycles

    def update_render_passes(self, scene, renderlayer):
        for made in [passes.COMBINED, *passes.asked(renderlayer), *passes.mask_passes(renderlayer)]:
            self.register_pass(scene, renderlayer, made.name_in(bpy.app.version), len(made.channels), made.channels, made.kind)

    def render(self, depsgraph):
        try:
            self._render(depsgraph)
        except (Unusable, find_program.NoProgram, flags.BadFlags, exr.BadPicture, OSError) as error:
            self._fail(str(error), depsgraph.view_layer.name)
        except main_thread.GivenUp:
            pass
        except KeyboardInterrupt:  # of a Python that runs Blender as a module
            self._fail("the render was interrupted before its picture had begun", depsgraph.view_layer.name)

    def _fail(self, line, layer):
        """One line for the user, and an empty picture, since Blender may be about to save one."""
        self.end_result(self.begin_result(0, 0, self.resolution_x, self.resolution_y, layer=layer))
        self.report({"ERROR"}, line)

    def _render(self, depsgraph):
        scene = depsgraph.scene.original
        job = sequence.current(scene, depsgraph.view_layer.name)
        if job is not None and scene.frame_current in job.frames:
            self._show(job, depsgraph, job.picture(scene.frame_current))
            return
        whole, reason = animation.is_whole(self, scene), None
        if whole or _needs_motion(scene, depsgraph.view_layer):
            reason = animation.obstacle(scene)
        notes = report.Notes()
        if reason:
            notes.add("animation", f"{reason} is not one glTF file; every frame is a run of its own, without motion")
        animated = reason is None and (whole or _needs_motion(scene, depsgraph.view_layer))
        folder = tempfile.mkdtemp(prefix="gatelight-")
        try:
            job = self._start(scene, depsgraph, folder, notes, animated, whole and animated)
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
        if whole and animated:
            sequence.keep(scene, depsgraph.view_layer.name, job)
            self._show(job, depsgraph, job.picture(scene.frame_current))
            return
        try:
            self._show(job, depsgraph, job.picture(scene.frame_current))
        finally:
            job.close()

    def _start(self, scene, depsgraph, folder, notes, animated, whole):
        """Exports and starts the program."""
        program = find_program.find(preferences.program_path())
        find_program.check(program)
        chosen = flags.of_panel(preferences.values(scene.gatelight))
        self.update_stats("", "Gatelight: exporting the scene")
        frames = list(animation.frames(scene)) if whole else [scene.frame_current]
        made = main_thread.run(lambda: export(scene, depsgraph, folder, notes, animated), self.test_break)
        notes.print()
        chosen = flags.for_media(chosen) if made.only_clear_media else chosen
        command = [program, "render", made.path, *made.flags, *chosen, "--exr", "float", "--progress", "json"]
        output = os.path.join(folder, "picture.exr")
        if animated:
            output = os.path.join(folder, "picture-{frame}.exr")
            numbers = f"{frames[0]}:{frames[-1]}:{scene.frame_step}" if whole else f"{frames[0]}:{frames[0]}"
            command += ["--frames", numbers, "--fps", _fps(scene.render), *_shutter(scene)]
        command += ["-o", output]
        return sequence.Job(run.Run(command), folder, output, frames, made, notes)

    def _show(self, job, depsgraph, path):
        """Waits for the picture of a frame, shows what is there meanwhile, and fills the passes at the end."""
        layer, summary, frame = depsgraph.view_layer, job.notes.summary(), depsgraph.scene.frame_current
        try:
            self._wait(job, layer, frame, path, summary)
        except KeyboardInterrupt:
            job.stop()
        failure = job.run.failure() if not job.is_finished(frame) else None
        if failure:
            raise Unusable(failure)
        if os.path.exists(path):
            self._fill(job, layer, path, [passes.COMBINED, *passes.asked(layer), *passes.mask_passes(layer)])
            os.remove(path)
        elif not self.test_break():
            raise Unusable(f"gatelight left no picture of frame {frame}: it was stopped before")
        for message in job.run.take_messages():
            print(f"Gatelight: {message}")
        self.update_stats("", summary)

    def _wait(self, job, layer, frame, path, summary):
        """Shows the growing picture until it is complete, or until the user has enough of it."""
        wait, shown, said = FIRST_SNAPSHOT, None, None
        due = time.monotonic() + wait
        while job.is_waiting(frame):
            said = self._show_progress(job, frame, summary, said)
            if self.test_break():
                job.stop()
                return
            if time.monotonic() > due and job.run.progress.get("phase") == "render":  # before, there is nothing to see
                wait = min(2.0 * wait, SLOWEST_SNAPSHOT)
                due = time.monotonic() + wait
                job.run.ask_for_snapshot()
            written = run.when_written(path)
            if written != shown and not job.is_finished(frame):
                shown = written
                self._fill(job, layer, path, [passes.COMBINED])
            time.sleep(POLL)

    def _show_progress(self, job, frame, summary, said):
        """The status, which on a command line is a line each time it changes."""
        event = job.run.progress
        here = event.get("frame", frame) == frame
        text = run.line_of(event) if here else f"Waiting for frame {frame}"
        line = " | ".join(part for part in (f"Gatelight: {text}", run.time_left(event), summary) if part)
        if line != said:
            self.update_stats("", line)
        if here:
            self.update_progress(min(max(event.get("fraction", 0.0), 0.0), 1.0))
        return line

    def _fill(self, job, layer, path, wanted):
        picture = exr.read(path)
        passes.flatten_depth(picture, job.exported.lens)
        height, width = picture.layers[""].shape[:2]
        result = self.begin_result(0, 0, width, height, layer=layer.name)
        if result is None or not result.layers:
            return
        for made in wanted:
            pixels = passes.pixels_of(made, picture)
            if pixels is None:
                continue
            name = made.name_in(bpy.app.version)
            if name not in result.layers[0].passes:
                self.add_pass(name, len(made.channels), made.channels, layer=layer.name)
            target = result.layers[0].passes.get(name)
            if target is not None:
                target.rect.foreach_set(pixels.reshape(-1))
        self.end_result(result)
        self._keep_manifests(picture, layer.name)

    def _keep_manifests(self, picture, layer):
        """The names behind the masks, which Blender writes to files and reads in its compositor."""
        result = self.get_result()
        for key, text in picture.attributes.items():
            if key.startswith("cryptomatte/"):
                result.stamp_data_add_field(key, f"{layer}.{text}" if key.endswith("/name") else text)


def _needs_motion(scene, view_layer):
    return scene.render.use_motion_blur or view_layer.use_pass_vector


def _shutter(scene):
    if not scene.render.use_motion_blur:
        return []
    length = scene.render.motion_blur_shutter
    position = getattr(scene.render, "motion_blur_position", "CENTER")
    opens = {"START": 0.0, "CENTER": -0.5 * length, "END": -length}[position]
    return ["--shutter", f"{opens:g}:{opens + length:g}"]


def _fps(render):
    """Frames of a second as the program reads them; Blender's base is 1.001 for 29.97."""
    base = render.fps_base
    if abs(base - 1.0) < 1e-6:
        return str(render.fps)
    return f"{round(render.fps * 1000)}/{round(base * 1000)}"
