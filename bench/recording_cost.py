#!/usr/bin/python3
"""Measures what recording costs and loses: demo_logger_node beside `rosbag record` and a subscriber that does nothing.

All three listen to the same publisher in the same run. Prints Markdown tables. Needs the devel space's setup file sourced (bench/run.sh does it).
CPU seconds are those of the whole process (all its threads) between the first message and the last.
"""
import argparse
import csv
import glob
import json
import os
import random
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time

RATES = [100, 500, 1000, 2000, 4000]
PEERS = ["floor", "rosbag", "demo_logger"]


def cpu_seconds(pid):
    total = 0
    for path in glob.glob(f"/proc/{pid}/task/*/schedstat"):
        try:
            with open(path) as file:
                total += int(file.read().split()[0])
        except (FileNotFoundError, ProcessLookupError):
            pass
    return total * 1e-9


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def wait_until(condition, what, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.005)
    sys.exit(f"recording_cost: waited {seconds} s for {what}")


class Bench:
    def __init__(self, programs, scratch):
        self.programs = programs
        self.scratch = scratch
        self.processes = []
        port = free_port()
        self.environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{port}", ROS_HOSTNAME="localhost",
                                ROS_HOME=f"{scratch}/ros", ROS_LOG_DIR=f"{scratch}/ros/log")
        os.environ.update(self.environment)
        self.master = self.start(["roscore", "-p", str(port)])
        import rosgraph
        wait_until(lambda: rosgraph.is_master_online(f"http://localhost:{port}"), "the ROS master")

    def start(self, command, stdout=subprocess.DEVNULL, cwd=None):
        process = subprocess.Popen(command, env=self.environment, stdin=subprocess.DEVNULL, stdout=stdout,
                                   stderr=subprocess.DEVNULL, text=True, cwd=cwd or self.scratch)
        self.processes.append(process)
        return process

    def start_peer(self, peer, folder):
        os.makedirs(folder, exist_ok=True)
        if peer == "floor":
            return self.start([f"{self.programs}/counting_subscriber"], stdout=subprocess.PIPE)
        if peer == "rosbag":
            return self.start(["/usr/lib/rosbag/record", "-O", f"{folder}/recording.bag", "/joint_states", "/teleop_cmd"])
        return self.start(["rosrun", "demo_logger", "demo_logger_node", f"_output_dir:={folder}/demos"])

    @staticmethod
    def real_pid(process):
        """rosrun replaces itself by the node, so its pid is the node's."""
        return process.pid

    def publish(self, rate, duration, subscribers):
        return self.start([f"{self.programs}/paced_publisher", str(rate), str(duration), str(subscribers)],
                          stdout=subprocess.PIPE)

    def stop_peer(self, peer, process, folder):
        """Ends it as its user would and returns how many joint states and commands it has kept."""
        process.send_signal(signal.SIGINT)
        if peer == "floor":
            out, _ = process.communicate(timeout=60)
            return tuple(int(word) for word in out.split())
        process.wait(timeout=120)
        if peer == "rosbag":
            import rosbag
            with rosbag.Bag(f"{folder}/recording.bag") as bag:
                return bag.get_message_count("/joint_states"), bag.get_message_count("/teleop_cmd")
        (sidecar,) = glob.glob(f"{folder}/demos/*.json")
        with open(sidecar) as file:
            metadata = json.load(file)
        with open(sidecar[:-5] + ".csv") as file:
            rows = sum(1 for _ in file) - 1
        assert rows == metadata["rows"]
        return rows, metadata["streams"][0]["received"]

    def run(self, rate, duration, peers, stalls=()):
        """One publisher, all peers at once. Returns {peer: (cpu seconds, joint states lost, commands lost)}."""
        folder = tempfile.mkdtemp(dir=self.scratch)
        running = {peer: self.start_peer(peer, f"{folder}/{peer}") for peer in peers}
        publisher = self.publish(rate, duration, len(peers))
        assert publisher.stdout.readline().strip() == "begin"
        before = {peer: cpu_seconds(self.real_pid(process)) for peer, process in running.items()}
        for at, length in stalls:
            time.sleep(at)
            for process in running.values():
                os.kill(self.real_pid(process), signal.SIGSTOP)
            time.sleep(length)
            for process in running.values():
                os.kill(self.real_pid(process), signal.SIGCONT)
        _, sent_joint_states, sent_commands, latest = publisher.stdout.readline().split()
        after = {peer: cpu_seconds(self.real_pid(process)) for peer, process in running.items()}
        publisher.wait()
        result = {}
        for peer, process in running.items():
            joint_states, commands = self.stop_peer(peer, process, f"{folder}/{peer}")
            result[peer] = (after[peer] - before[peer], int(sent_joint_states) - joint_states,
                            int(sent_commands) - commands, int(sent_joint_states) + int(sent_commands))
        shutil.rmtree(folder)
        return result

    def close(self):
        for process in reversed(self.processes):
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self.processes:
            try:
                process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                process.kill()


def cost_table(bench, repeats, duration):
    print("### CPU seconds per 1000 messages, and messages lost (joint states at the rate given + 100 Hz Twist)\n")
    print("| rate Hz | floor | rosbag record | demo_logger | demo_logger / floor | demo_logger / rosbag | lost: floor | "
          "lost: rosbag | lost: demo_logger |\n|---|---|---|---|---|---|---|---|---|")
    for rate in RATES:
        runs = [bench.run(rate, duration, PEERS) for _ in range(repeats)]
        cost = {peer: [1000 * run[peer][0] / run[peer][3] for run in runs] for peer in PEERS}
        lost = {peer: [run[peer][1] + run[peer][2] for run in runs] for peer in PEERS}
        to_floor = statistics.median(ours / floor for ours, floor in zip(cost["demo_logger"], cost["floor"]))
        to_rosbag = statistics.median(ours / rosbag for ours, rosbag in zip(cost["demo_logger"], cost["rosbag"]))
        medians = " | ".join(f"{statistics.median(cost[peer]):.4f}" for peer in PEERS)
        losses = " | ".join(" ".join(str(n) for n in lost[peer]) for peer in PEERS)
        print(f"| {rate} | {medians} | {to_floor:.2f} | {to_rosbag:.2f} | {losses} |", flush=True)


def loss_table(bench, repeats):
    print("\n### Messages lost under load and when the recorder is stopped (SIGSTOP), each recorder alone with the publisher\n")
    print("| case | rosbag record | demo_logger |\n|---|---|---|")
    cases = [("8 kHz for 10 s", 8000, 10, ()),
             ("1 kHz, stopped 3 x 150 ms", 1000, 8, ((1, 0.15), (1, 0.15), (1, 0.15))),
             ("1 kHz, stopped 1 x 1 s", 1000, 8, ((2, 1.0),)),
             ("4 kHz, stopped 3 x 150 ms", 4000, 8, ((1, 0.15), (1, 0.15), (1, 0.15)))]
    for name, rate, duration, stalls in cases:
        cells = []
        for peer in ["rosbag", "demo_logger"]:
            runs = [bench.run(rate, duration, [peer], stalls)[peer] for _ in range(repeats)]
            cells.append(", ".join(f"{lost + lost_commands} of {sent}" for _, lost, lost_commands, sent in runs))
        print(f"| {name} | {cells[0]} | {cells[1]} |", flush=True)


def last_stamp(path):
    with open(path[:-4] + ".json") as file:
        start = json.load(file)["start_stamp"]
    with open(path) as file:
        last = list(csv.reader(file))[-1]
    return start["secs"] + start["nsecs"] * 1e-9 + float(last[0])


def kill_table(bench, times, seed):
    print(f"\n### kill -9 at {times} random moments of a 1 kHz recording (seed {seed})\n")
    generator = random.Random(seed)
    losses = []
    damaged = 0
    for _ in range(times):
        folder = tempfile.mkdtemp(dir=bench.scratch)
        node = bench.start_peer("demo_logger", folder)
        publisher = bench.publish(1000, 30, 1)
        assert publisher.stdout.readline().strip() == "begin"
        time.sleep(1.0 + 4.0 * generator.random())
        killed = time.time()
        node.kill()
        node.wait()
        publisher.send_signal(signal.SIGINT)
        publisher.wait()
        subprocess.run(["rosrun", "demo_logger", "demo_tool", "recover", f"{folder}/demos"], env=bench.environment,
                       stdout=subprocess.DEVNULL, check=True)
        (recovered,) = glob.glob(f"{folder}/demos/*.csv")
        check = subprocess.run(["rosrun", "demo_logger", "demo_tool", "info", recovered], env=bench.environment,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        damaged += check.returncode != 0
        losses.append(killed - last_stamp(recovered))
        shutil.rmtree(folder)
    print("| recovered and readable | lost of the open episode: median | largest | allowed (max_wait + 100 ms) |\n|---|---|---|---|")
    print(f"| {times - damaged} of {times} | {1e3 * statistics.median(losses):.0f} ms | {1e3 * max(losses):.0f} ms | 200 ms |", flush=True)


def stop_table(bench, repeats, duration):
    print(f"\n### From ~stop to the renamed file, {duration} s episode at 1 kHz\n")
    import rospy
    from demo_logger.srv import Stop
    rospy.init_node("recording_cost", anonymous=True, disable_signals=True)
    service = []
    for _ in range(repeats):
        folder = tempfile.mkdtemp(dir=bench.scratch)
        node = bench.start_peer("demo_logger", folder)
        publisher = bench.publish(1000, duration, 1)
        assert publisher.stdout.readline().strip() == "begin"
        publisher.stdout.readline()
        rospy.wait_for_service("/demo_logger/stop", 10)
        stop = rospy.ServiceProxy("/demo_logger/stop", Stop)
        before = time.monotonic()
        reply = stop("success", "")
        service.append(time.monotonic() - before)
        assert reply.success and os.path.exists(reply.file), reply
        publisher.wait()
        node.send_signal(signal.SIGINT)
        node.wait()
        shutil.rmtree(folder)
    print("| median | largest | reach |\n|---|---|---|")
    print(f"| {1e3 * statistics.median(service):.0f} ms | {1e3 * max(service):.0f} ms | 200 ms |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", help="folder of paced_publisher and counting_subscriber")
    parser.add_argument("--repeats", type=int, default=3, help="runs per line, medians are quoted (default 3)")
    parser.add_argument("--duration", type=float, default=15.0, help="seconds per run of the cost table (default 15)")
    parser.add_argument("--kills", type=int, default=20, help="kill -9 runs (default 20)")
    parser.add_argument("--only", choices=["cost", "loss", "kill", "stop"], help="one table alone")
    arguments = parser.parse_args()
    scratch = tempfile.mkdtemp(prefix="demo_logger_bench_")
    bench = Bench(os.path.abspath(arguments.programs), scratch)
    try:
        if arguments.only in (None, "cost"):
            cost_table(bench, arguments.repeats, arguments.duration)
        if arguments.only in (None, "loss"):
            loss_table(bench, arguments.repeats)
        if arguments.only in (None, "kill"):
            kill_table(bench, arguments.kills, seed=7)
        if arguments.only in (None, "stop"):
            stop_table(bench, arguments.repeats, 60)
    finally:
        bench.close()
        shutil.rmtree(scratch, ignore_errors=True)


if __name__ == "__main__":
    main()
