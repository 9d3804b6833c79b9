#!/usr/bin/python3
"""Draws one recorded demonstration: its joints, its commands and the path of the tool."""

import argparse
import io
import json
import os
import sys

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import numpy as np
except ImportError as error:
    sys.exit(f"draw_demonstration.py: {error}; install it with: sudo apt-get install python3-matplotlib python3-numpy")

JOINT_COLOURS = plt.get_cmap("tab10").colors
AXIS_COLOURS = {"x": "#c0392b", "y": "#1e8449", "z": "#1f5fa8"}
TEXT = "#333333"


def read_text(path):
    """Throws ValueError in one sentence that names the file."""
    if os.path.exists(path) and not os.path.isfile(path):  # a device or a pipe may never end
        raise ValueError(f"{path}: is no regular file; is it a demonstration?")
    try:
        with open(path, encoding="utf-8") as file:
            return file.read()
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: no text, byte {error.start} is not UTF-8; is it a demonstration?") from None
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror}") from None


class Demonstration:
    """The columns of one CSV, and what its sidecar says about them where there is one."""

    def __init__(self, path):
        self.path = path
        header, _, rows = read_text(path).partition("\n")
        self.names = header.strip().split(",")
        lines = rows.splitlines()
        if len(lines) < 2:
            raise ValueError(f"{path}: {len(lines)} rows, expected at least 2 to draw")
        try:
            table = np.loadtxt(lines, delimiter=",", ndmin=2)
        except ValueError as error:
            raise ValueError(f"{path}: {error} (row 0 follows the header); `demo_tool check` says more") from None
        self.values = dict(zip(self.names, table.T))
        if "time" not in self.values:
            raise ValueError(f"{path}: has no column \"time\"; is it a demonstration?")
        self.time = self.values["time"]
        sidecar = os.path.splitext(path)[0] + ".json"
        self.metadata = {}
        if os.path.exists(sidecar):
            try:
                self.metadata = json.loads(read_text(sidecar))
            except json.JSONDecodeError as error:
                raise ValueError(f"{sidecar}: no JSON: {error}") from None
        self.units = {column["name"]: column.get("unit", "") for column in self.metadata.get("columns", [])}

    def group(self, names):
        """Those of `names` that hold at least one number."""
        return [name for name in names if name in self.values and np.isfinite(self.values[name]).any()]

    def joints(self, prefix):
        """Those columns of all joints that hold at least one number."""
        return self.group(self.joint_columns(prefix))

    def joint_columns(self, prefix):
        """The columns of all joints, by the names that the recorder had to make portable where it had to."""
        column_of = {original: name for name, original in self.metadata.get("original_names", {}).items()}
        listed = [prefix + joint for joint in self.metadata.get("robot", {}).get("joints") or []]
        if listed:
            return [name for name in (column_of.get(name, name) for name in listed) if name in self.values]
        return [name for name in self.names if name.startswith(prefix)]

    def title(self):
        parts = [self.metadata.get("id", ""), self.metadata.get("task", "")]
        channel = self.metadata.get("channel", "unknown")
        parts.append("" if channel == "unknown" else channel)
        outcome = self.metadata.get("outcome", "unknown")
        parts.append("" if outcome == "unknown" else outcome)
        return " · ".join(part for part in parts if part)


def unit_label(quantity, units):
    known = sorted({unit for unit in units if unit})
    return f"{quantity} [{', '.join(known)}]" if known else quantity


def style(axes):
    axes.grid(True, color="#e4e4e4", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color("#999999")
    axes.tick_params(colors=TEXT, labelsize=8)


def legend_beside(axes):
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8, handlelength=1.2)


def draw_joints(axes, demonstration, names, prefix, quantity, default_unit):
    for index, name in enumerate(names):
        colour = JOINT_COLOURS[index % len(JOINT_COLOURS)]
        axes.plot(demonstration.time, demonstration.values[name], color=colour, linewidth=1.3, label=name[len(prefix):])
    units = [demonstration.units.get(name, default_unit) for name in names]
    axes.set_ylabel(unit_label(quantity, units), fontsize=9, color=TEXT)
    legend_beside(axes)


def draw_commands(axes, demonstration, names, quantity, default_unit):
    """Commands are held until the next one: steps, never slopes."""
    for index, name in enumerate(names):
        colour = AXIS_COLOURS.get(name[-1], JOINT_COLOURS[index % len(JOINT_COLOURS)])
        axes.step(demonstration.time, demonstration.values[name], where="post", color=colour, linewidth=1.2,
                  label=name.replace("u_", "", 1))
    units = [demonstration.units.get(name, default_unit) for name in names]
    axes.set_ylabel(unit_label(quantity, units), fontsize=9, color=TEXT)
    legend_beside(axes)


def draw_tool_path(figure, place, demonstration):
    """The path of the tool in space, and below it as seen from above and from the side, on one scale."""
    path = np.column_stack([demonstration.values[name] for name in ("ee_x", "ee_y", "ee_z")])
    known = np.isfinite(path).all(axis=1)
    path, time = path[known], demonstration.time[known]
    thinned = slice(None, None, max(1, len(path) // 4000))
    middle = (path.max(axis=0) + path.min(axis=0)) / 2
    reach = max((path.max(axis=0) - path.min(axis=0)).max() / 2 * 1.1, 1e-3)
    limits = [(centre - reach, centre + reach) for centre in middle]
    rows = place.subgridspec(2, 2, height_ratios=[1.6, 1.0])

    with plt.rc_context({"grid.color": "#dcdcdc", "grid.linewidth": 0.6}):
        space = figure.add_subplot(rows[0, :], projection="3d")
    space.plot(path[:, 0], path[:, 1], limits[2][0], color="#cccccc", linewidth=1.0)
    dots = space.scatter(*path[thinned].T, c=time[thinned], cmap="viridis", s=5, linewidths=0, depthshade=False)
    space.scatter(*path[0], color="white", edgecolor=TEXT, s=45, label="start", depthshade=False, zorder=5)
    space.scatter(*path[-1], color=TEXT, marker="s", s=40, label="end", depthshade=False, zorder=5)
    space.set(xlim=limits[0], ylim=limits[1], zlim=limits[2])
    for axis, name in ((space.xaxis, "x [m]"), (space.yaxis, "y [m]"), (space.zaxis, "z [m]")):
        axis.set_label_text(name, fontsize=9, color=TEXT)
        axis.set_pane_color((0.97, 0.97, 0.97, 1.0))
        axis.set_major_locator(matplotlib.ticker.MaxNLocator(5))
    space.tick_params(colors=TEXT, labelsize=7)
    space.view_init(elev=24, azim=-58)
    space.set_box_aspect((1, 1, 1), zoom=1.15)
    space.set_title("tool path in the base frame", fontsize=10, color=TEXT, pad=0)
    space.legend(loc="upper left", frameon=False, fontsize=8)
    bar = figure.colorbar(dots, ax=space, shrink=0.75, pad=0.12, fraction=0.04)
    bar.set_label("time [s]", fontsize=8, color=TEXT)
    bar.ax.tick_params(labelsize=7, colors=TEXT)
    bar.outline.set_visible(False)

    for column, (across, up, view) in enumerate(((0, 1, "from above"), (0, 2, "from the side"))):
        axes = figure.add_subplot(rows[1, column])
        style(axes)
        axes.scatter(path[thinned, across], path[thinned, up], c=time[thinned], cmap="viridis", s=3, linewidths=0)
        axes.plot(*path[0, [across, up]], "o", markerfacecolor="white", markeredgecolor=TEXT, markersize=6)
        axes.plot(*path[-1, [across, up]], "s", color=TEXT, markersize=5)
        axes.set(xlim=limits[across], ylim=limits[up], aspect="equal")
        axes.xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(4))
        axes.yaxis.set_major_locator(matplotlib.ticker.MaxNLocator(4))
        axes.set_xlabel("xyz"[across] + " [m]", fontsize=9, color=TEXT)
        axes.set_ylabel("xyz"[up] + " [m]", fontsize=9, color=TEXT)
        axes.set_title(view, fontsize=9, color=TEXT)


def add_output_options(parser):
    parser.add_argument("-o", "--output", help="PNG, SVG or PDF, by its ending (PNG without one); default: beside the "
                        "CSV, .png")
    parser.add_argument("--force", action="store_true", help="overwrite a picture that is there; else it is refused")


def output_of(arguments):
    """Where the picture goes. Throws ValueError if something is there that must stay."""
    output = arguments.output or os.path.splitext(arguments.csv)[0] + ".png"
    if os.path.isfile(output) and os.path.samefile(output, arguments.csv):
        raise ValueError(f"{output}: is the recording itself, expected another name for its picture")
    if os.path.isfile(output) and not arguments.force:
        raise ValueError(f"{output}: exists already and is not overwritten; choose another name, or add --force")
    return output


def save(figure, output, dpi):
    """Under this very name, once the whole picture is there."""
    picture = io.BytesIO()
    kind = os.path.splitext(output)[1][1:].lower() or "png"
    if kind not in figure.canvas.get_supported_filetypes():
        raise ValueError(f"{output}: no kind of picture ends in .{kind}, expected .png, .svg or .pdf")
    figure.savefig(picture, format=kind, dpi=dpi, facecolor="white")
    try:
        with open(output, "wb") as file:
            file.write(picture.getbuffer())
    except OSError as error:
        raise ValueError(f"{output}: cannot be written: {error.strerror}") from None


def draw(demonstration, output):
    panels = []
    positions = demonstration.joints("q_")
    if positions:
        panels.append((1.5, lambda axes: draw_joints(axes, demonstration, positions, "q_", "joint position", "rad")))
    speeds = demonstration.joints("dq_")
    if speeds:
        panels.append((1.0, lambda axes: draw_joints(axes, demonstration, speeds, "dq_", "joint velocity", "rad/s")))
    linear = demonstration.group(["u_vx", "u_vy", "u_vz"])
    if linear:
        panels.append((1.0, lambda axes: draw_commands(axes, demonstration, linear, "command", "m/s")))
    angular = [name for name in demonstration.group(["u_wx", "u_wy", "u_wz"]) if np.nanmax(
        np.abs(demonstration.values[name])) > 0.0]
    if angular:
        panels.append((1.0, lambda axes: draw_commands(axes, demonstration, angular, "command", "rad/s")))
    if not panels:
        raise ValueError("neither joint positions, velocities nor commands to draw")

    with_path = len(demonstration.group(["ee_x", "ee_y", "ee_z"])) == 3
    figure = plt.figure(figsize=(13.0 if with_path else 8.0, 1.0 + 1.7 * sum(height for height, _ in panels)),
                        layout="constrained")
    grid = figure.add_gridspec(len(panels), 2 if with_path else 1, height_ratios=[height for height, _ in panels],
                               width_ratios=[1.1, 1.0] if with_path else None)
    first = None
    for row, (_, draw_panel) in enumerate(panels):
        axes = figure.add_subplot(grid[row, 0], sharex=first)
        first = first or axes
        style(axes)
        draw_panel(axes)
        axes.tick_params(labelbottom=row == len(panels) - 1)
    axes.set_xlabel("time [s]", fontsize=9, color=TEXT)
    first.set_xlim(demonstration.time[0], demonstration.time[-1])
    if with_path:
        draw_tool_path(figure, grid[:, 1], demonstration)
    rate = (len(demonstration.time) - 1) / (demonstration.time[-1] - demonstration.time[0])
    figure.suptitle(f"{demonstration.title()}   ({len(demonstration.time)} rows, {rate:.4g} Hz)", fontsize=11, color=TEXT)
    save(figure, output, dpi=110)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, epilog="example: rosrun demo_logger draw_demonstration.py demos/demo_000001.csv -o demo.png")
    parser.add_argument("csv", help="a demonstration; its sidecar .json beside it is used where it exists")
    add_output_options(parser)
    arguments = parser.parse_args()
    try:
        output = output_of(arguments)
        draw(Demonstration(arguments.csv), output)
    except ValueError as error:
        print(f"draw_demonstration.py: {error}", file=sys.stderr)
        return 2
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
