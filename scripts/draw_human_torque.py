#!/usr/bin/python3
"""Draws the torque of the hand that guided an arm, joint by joint: as recovered, and beside it, where they are known,
the truth (columns truth_<joint>, of a simulated arm) and what an observer said as it happened."""

import argparse
import sys

from draw_demonstration import TEXT, Demonstration, add_output_options, np, output_of, plt, save, style

TRUE = "#b9b9b9"
RECOVERED = "#c8371b"
LIVE = "#1f6fb2"
EDGE = 0.25  # [s] at either end, where a smoother knows one side only


def error_in_percent(found, truth, time, peak):
    inside = (time > time[0] + EDGE) & (time < time[-1] - EDGE) & np.isfinite(found) & np.isfinite(truth)
    return 100.0 * np.sqrt(np.mean((found[inside] - truth[inside]) ** 2)) / peak if inside.any() else np.nan


def draw_joint(axes, joint, taught, live):
    style(axes)
    time = taught.time
    found = taught.values["tau_h_" + joint]
    truth = taught.values.get("truth_" + joint)
    if truth is not None:
        axes.plot(time, truth, color=TRUE, linewidth=4.5, label="true")
    if live is not None and "tau_h_" + joint in live.values:
        axes.plot(live.time, live.values["tau_h_" + joint], color=LIVE, linewidth=1.2, label="as it happened")
    deviation = taught.values.get("tau_h_std_" + joint)
    if deviation is not None:
        axes.fill_between(time, found - 2 * deviation, found + 2 * deviation, color=RECOVERED, alpha=0.2, linewidth=0,
                          label="± 2 standard deviations")
    axes.plot(time, found, color=RECOVERED, linewidth=0.9, label="recovered")
    title = joint
    if truth is not None:
        peak = np.nanmax(np.abs(truth))
        title += f"   off by {error_in_percent(found, truth, time, peak):.2g} % of its peak" if peak > 0.0 else ""
    axes.set_title(title, fontsize=9, color=TEXT, loc="left")
    axes.set_ylabel(f"[{taught.units.get('tau_h_' + joint) or 'N m'}]", fontsize=8, color=TEXT)


def explain(axes, taught, live, joints, handles):
    axes.axis("off")
    axes.legend(*handles, loc="upper left", frameon=False, fontsize=9)
    truths = [taught.values.get("truth_" + joint) for joint in joints]
    if any(truth is None for truth in truths):
        return
    peak = max(np.nanmax(np.abs(truth)) for truth in truths)
    if not peak > 0.0:
        return

    def overall(source):
        errors = [error_in_percent(source.values["tau_h_" + joint], truth, taught.time, peak)
                  for joint, truth in zip(joints, truths)]
        return np.sqrt(np.mean(np.square(errors)))

    text = f"all joints, root mean square, of the peak of {peak:.3g} N m:\n   recovered {overall(taught):.2g} %"
    if live is not None and len(live.time) == len(taught.time):
        text += f"\n   as it happened {overall(live):.2g} %, late by the observer's delay"
    axes.text(0.02, 0.3, text, transform=axes.transAxes, fontsize=9, color=TEXT, va="top", linespacing=1.5)


def torque_columns(names):
    return [name for name in names if not name.startswith("tau_h_std_")]


def joints_of(demonstration):
    """Those whose torque is known."""
    there = torque_columns(demonstration.joint_columns("tau_h_"))
    if not there:
        raise ValueError(f"{demonstration.path}: no column tau_h_<joint> to draw; `demo_tool torque` adds them")
    known = torque_columns(demonstration.joints("tau_h_"))
    if not known:
        raise ValueError(f"{demonstration.path}: the columns {', '.join(there)} hold no number; `demo_tool check` says "
                         "which inputs are missing")
    return [name[len("tau_h_"):] for name in known]


def require_same_recording(taught, live):
    """What was measured stays as it was in what is made of a recording."""
    joints, others = ([name[len("q_"):] for name in one.joint_columns("q_")] for one in (taught, live))
    if set(joints) != set(others):
        raise ValueError(f"{live.path}: joints {', '.join(others) or 'none'}, expected those of {taught.path}, "
                         f"{', '.join(joints) or 'none'}, which --live is the recording of")
    parent = taught.metadata.get("provenance", {}).get("parent")
    expected = f"{taught.path}, which was made of {parent}" if parent else f"{taught.path}, which it is the recording of"
    _, rows, live_rows = np.intersect1d(taught.time, live.time, return_indices=True)
    if not len(rows):
        raise ValueError(f"--live {live.path}: {live.time[0]:g} to {live.time[-1]:g} s, none of them a time of {expected}")
    measured = taught.joint_columns("q_") + taught.joint_columns("tau_")
    for name in measured:
        if name not in live.values or name.startswith("tau_h_"):
            continue
        here, there = taught.values[name][rows], live.values[name][live_rows]
        differing = np.flatnonzero(~np.isclose(here, there, rtol=1e-9, atol=1e-12, equal_nan=True))
        if len(differing):
            row = differing[0]
            raise ValueError(f"--live {live.path}: {name} is {there[row]:.6g} at {taught.time[rows[row]]:g} s, expected "
                             f"{here[row]:.6g} as in {expected}")


def draw(taught, live, output):
    joints = joints_of(taught)
    if live is not None:
        require_same_recording(taught, live)
    rows = len(joints) // 2 + 1
    figure, grid = plt.subplots(rows, 2, figsize=(11.0, 0.7 + 1.75 * rows), sharex=True, layout="constrained")
    panels = grid.T.flatten()
    for axes, joint in zip(panels, joints):
        draw_joint(axes, joint, taught, live)
    for axes in panels[len(joints):]:
        axes.axis("off")
    explain(panels[len(joints)], taught, live, joints, panels[0].get_legend_handles_labels())
    panels[min(rows, len(joints)) - 1].set_xlabel("time [s]", fontsize=9, color=TEXT)
    panels[len(joints) - 1].tick_params(labelbottom=True)  # the lowest of the second column
    panels[0].set_xlim(taught.time[0], taught.time[-1])
    figure.suptitle(f"Torque of the hand   ({taught.title()})", fontsize=11, color=TEXT)
    save(figure, output, dpi=100)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="example: rosrun demo_logger draw_human_torque.py taught.csv --live demos/demo_000001.csv -o torque.png")
    parser.add_argument("csv", help="a demonstration with columns tau_h_<joint>, as `demo_tool torque` writes it")
    parser.add_argument("--live", help="the recording it was made of, whose tau_h_<joint> are those of the observer")
    add_output_options(parser)
    arguments = parser.parse_args()
    try:
        output = output_of(arguments)
        live = Demonstration(arguments.live) if arguments.live else None
        draw(Demonstration(arguments.csv), live, output)
    except ValueError as error:
        print(f"draw_human_torque.py: {error}", file=sys.stderr)
        return 2
    print(output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
