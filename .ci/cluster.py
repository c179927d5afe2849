#!/usr/bin/env python3
"""`phong batch` on real schedulers, with tasks killed: `python3 .ci/cluster.py`.

A Slurm of this machine alone (slurmctld, slurmd and munged, as root, on ports of their own) works on
an array of tasks. Meanwhile a job is killed, one is sent back into the queue, and processes are
killed outright. In the end every picture has the bytes of `phong render`, and nothing was begun more
often than it was lost. Then GNU parallel and make do batches with shares, and tasks are killed at
random moments (`--kills N`, 10 unless told) and begun again.

Slurm, munge and parallel are installed from Debian's packages where they are missing. `--program`
is the program to try; `--only PART` does one of slurm, parallel, make and kills.
"""

import argparse
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "target/cluster"

SCENE = """version = 1
[image]
size = [96, 64]
samples = 64
[camera]
eye = [0, 2, 6]
look_at = [0, 0.7, 0]
[[light]]
kind = "point"
position = [3, 5, 4]
radius = 0.5
[materials.red]
color = "#c8402f"
shininess = 20
reflection = 0.3
[[include]]
file = "floor.toml"
[[sphere]]
center = [0, 1, 0]
radius = 1
material = "red"
"""
FLOOR = """[materials.floor]
color = 0.6
[[plane]]
point = [0, 0, 0]
normal = [0, 1, 0]
material = "floor"
"""
BATCH = """version = 1
inputs = "balls.toml"
output = "{output}"
options = "--samples {samples}"
{keys}
[parameters]
"materials.red.shininess" = {shininess}
"camera.eye" = {{ from = [-2, 2, 6], to = [2, 2, 6], steps = {steps} }}
[slurm]
time = "5:00"
"""


def run(*words, **options):
    """What a command says; it has to succeed."""
    options = {"check": True, "text": True, "stdout": subprocess.PIPE, **options}
    return subprocess.run([str(word) for word in words], **options).stdout


def install():
    """Debian's packages of what is missing."""
    programs = {"slurmctld": "slurmctld", "slurmd": "slurmd", "sbatch": "slurm-client",
                "munged": "munge", "parallel": "parallel", "make": "make"}
    path = os.pathsep.join([os.environ["PATH"], "/usr/sbin", "/sbin"])
    missing = [package for name, package in programs.items() if not shutil.which(name, path=path)]
    if missing:
        root = [] if os.getuid() == 0 else ["sudo"]
        run(*root, "apt-get", "update", "-q")
        run(*root, "env", "DEBIAN_FRONTEND=noninteractive", "apt-get", "install", "-qy", *missing)


def until(what, condition, seconds=60):
    """Waits for something to become true."""
    end = time.monotonic() + seconds
    while not (answer := condition()):
        if time.monotonic() > end:
            sys.exit(f"waited {seconds} s in vain: {what}")
        time.sleep(0.05)
    return answer


class Batch:
    """A batch file in the work folder, and what became of it."""

    def __init__(self, phong, output, samples=64, keys="", shininess="[1, 10, 100, 1000]", steps=6):
        self.phong = phong
        self.file = WORK / f"{output}.toml"
        self.output = WORK / output
        shutil.rmtree(self.output, ignore_errors=True)
        self.samples = samples
        self.file.write_text(BATCH.format(
            output=output, samples=samples, keys=keys, shininess=shininess, steps=steps))

    def status(self):
        """The answer of `--status --json`."""
        words = [self.phong, "batch", self.file, "--status", "--json"]
        return json.loads(run(*words, check=False))

    def script(self, kind):
        """The script that has it done."""
        path = WORK / f"{self.output.name}.{kind}"
        path.write_text(run(self.phong, "batch", self.file, "--script", kind))
        return path

    def starts(self):
        """How often each task was begun, by the records of all tasks."""
        count = Counter()
        for record in sorted((self.output / ".batch").glob("*.jsonl")):
            for line in record.read_text().splitlines():
                if '"event":"start"' in line:
                    count[record.name] += 1
        return count

    def check(self):
        """Every picture is there, and has the bytes that `phong render` writes."""
        pictures = json.loads((self.output / "index.json").read_text())
        for picture in pictures:
            words = [f"{key}={json.dumps(value)}" for key, value in picture["parameters"].items()]
            words = [word for change in words for word in ("--set", change)]
            alone = self.output.with_suffix(".alone.png")
            run(self.phong, "render", WORK / "balls.toml", "--samples", self.samples, *words,
                "--quiet", "-o", alone)
            named = self.output / picture["name"]
            if named.read_bytes() != alone.read_bytes():
                sys.exit(f"{named} is not what `phong render` draws: {words}")
        left = [path.name for path in (self.output / "by-content").iterdir()
                if not path.name.endswith(".png")]
        if left:
            sys.exit(f"left behind: {left}")
        return len(pictures)


class Slurm:
    """A cluster of one node, with all it needs in one folder."""

    CONFIG = """ClusterName=phong
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=2
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
KillWait=5
SchedulerParameters=sched_interval=1,sched_min_interval=0,batch_sched_delay=0,bf_interval=1
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""

    def __init__(self):
        self.folder = WORK / "slurm"
        shutil.rmtree(self.folder, ignore_errors=True)
        for name in ("state", "spool"):
            (self.folder / name).mkdir(parents=True)
        os.chmod(self.folder, 0o755)
        self.daemons = []
        ports = []
        for _ in range(2):
            with socket.socket() as free:
                free.bind(("127.0.0.1", 0))
                ports.append(free.getsockname()[1])
        config = self.folder / "slurm.conf"
        config.write_text(self.CONFIG.format(
            host=socket.gethostname().split(".")[0], controller=ports[0], node=ports[1],
            folder=self.folder, cores=os.cpu_count()))
        os.environ["SLURM_CONF"] = str(config)
        os.environ["PATH"] += ":/usr/sbin:/sbin"

    def __enter__(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o400)
        self.start("munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={self.folder}/munge.socket", f"--pid-file={self.folder}/munge.pid",
                   f"--log-file={self.folder}/munge.log", f"--seed-file={self.folder}/munge.seed")
        until("munged", (self.folder / "munge.socket").exists)
        self.start("slurmctld", "-D", "-c")
        self.start("slurmd", "-D")
        until("the node is idle", lambda: "idle" in run("sinfo", "-h", "-o", "%T", check=False))
        return self

    def start(self, *words):
        """A daemon that ends with us."""
        log = open(self.folder / f"{words[0]}.out", "w")
        self.daemons.append(subprocess.Popen(words, stdout=log, stderr=log, start_new_session=True))

    def __exit__(self, *_):
        subprocess.run(["scancel", "--user=root"], stderr=subprocess.DEVNULL)
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    @staticmethod
    def jobs():
        """How the scheduler sees each job of an array: its number in the array and its state."""
        said = run("squeue", "-h", "-r", "-o", "%K %T").split("\n")
        return dict(line.split() for line in said if line.strip())


def running(batch):
    """The tasks that are being worked on, by their numbers."""
    return {task["task"]: task for task in batch.status()["tasks"] if task["state"] == "running"}


def slurm(phong):
    """An array of 24 tasks; one job killed, one requeued, two processes killed."""
    batch = Batch(phong, "slurm-sweep", samples=6000)
    with Slurm() as cluster:
        script = batch.script("slurm")
        said = run("bash", script).split()
        array = said[-1]
        lost = Counter()

        def one():
            """A task that has worked long enough to have something to lose."""
            task = until("a task runs", lambda: next(iter(running(batch).values()), None))
            until("its checkpoint", lambda: Path(f"{task['file']}.part").exists())
            return task

        task = one()
        run("scancel", "--signal=KILL", task["job"])
        lost["scancel --signal=KILL"] += 1
        until("the killed job is gone", lambda: task["task"] not in running(batch))
        task = one()
        run("scontrol", "requeue", task["job"])
        lost["scontrol requeue"] += 1
        until("the job is back", lambda: cluster.jobs().get(str(task["task"])) == "PENDING")
        # Slurm lets a requeued job wait for minutes.
        run("scontrol", "update", f"JobId={task['job']}", "StartTime=now")
        for _ in range(2):
            task = one()
            os.kill(task["process"], signal.SIGKILL)
            lost["kill -9"] += 1
            until("the process is gone", lambda: task["task"] not in running(batch))
        until("the array is done", lambda: not cluster.jobs(), 400)
        after = {word: batch.status()[word] for word in ("done", "killed", "interrupted", "failed")}
        print(f"array {array} of 24 tasks; lost: {dict(lost)}; then {after}")
        # What was killed has not been done; handed in again, what is done is left alone.
        run("bash", script)
        until("the second array is done", lambda: not cluster.jobs(), 400)
    starts = batch.starts()
    pictures = batch.check()
    again = sum(starts.values()) - pictures
    print(f"{pictures} pictures, each with the bytes of `phong render`; {sum(starts.values())} starts")
    if again != sum(lost.values()):
        sys.exit(f"begun again: {again}; lost: {sum(lost.values())}: {starts}")
    sharing(phong)


def sharing(phong):
    """Shares and the pictures put together of them, by a second array that waits for the first."""
    batch = Batch(phong, "slurm-shares", keys="shares = 3", shininess="[1, 100]", steps=2)
    with Slurm() as cluster:
        run("bash", batch.script("slurm"))
        until("both arrays are done", lambda: not cluster.jobs(), 400)
    print(f"{batch.check()} pictures of 3 shares each, by two arrays; {sum(batch.starts().values())} starts")


def parallel(phong):
    """GNU parallel, in two rounds."""
    batch = Batch(phong, "parallel-shares", keys="shares = 2")
    script = batch.script("gnu-parallel")
    run("bash", script, stderr=subprocess.DEVNULL)
    print(f"parallel: {batch.check()} pictures of 2 shares each; {sum(batch.starts().values())} starts")
    run("bash", script, stderr=subprocess.DEVNULL)
    if sum(batch.starts().values()) != 72:
        sys.exit(f"not 72 starts: {batch.starts()}")


def make(phong):
    """make, whose prerequisites are the shares."""
    batch = Batch(phong, "make-shares", keys="shares = 2")
    script = batch.script("make")
    run("make", f"--jobs={os.cpu_count()}", "-f", script)
    print(f"make: {batch.check()} pictures of 2 shares each; {sum(batch.starts().values())} starts")
    run("make", f"--jobs={os.cpu_count()}", "-f", script)
    if sum(batch.starts().values()) != 72:
        sys.exit(f"not 72 starts: {batch.starts()}")


def kills(phong, count):
    """So many tasks killed, each at a random moment, and begun again until all pictures are there."""
    chance = random.Random(time.time_ns())
    batch = Batch(phong, "kills", samples=2000, shininess=f"{{ from = 1, to = {count}, steps = {count} }}",
                  steps=1)
    words = [str(phong), "batch", str(batch.file), "--threads", "1", "--task"]
    batch.script("make")
    files = [Path(task["file"]) for task in batch.status()["tasks"]]
    # How long a task takes that is let alone.
    killed, goes_on, began = 0, 0, time.monotonic()
    run(*words, "0")
    whole = time.monotonic() - began
    files[0].unlink()
    for number in range(count):
        died = False
        while not died:
            task = subprocess.Popen([*words, str(number)])
            try:
                task.wait(chance.uniform(0, whole))
                # It was faster than that: another moment, with its picture taken away.
                files[number].unlink()
            except subprocess.TimeoutExpired:
                task.kill()
                died = task.wait() == -signal.SIGKILL
        killed += 1
        run(*words, str(number))
    for record in (batch.output / ".batch").glob("*.jsonl"):
        goes_on += record.read_text().count('"goes_on":true')
    status = batch.status()
    if status["done"] != count:
        sys.exit(f"not all is done: {status}")
    print(f"kills: {killed} tasks killed at random within {whole:.2f} s, {goes_on} went on from a "
          f"checkpoint; {batch.check()} right pictures")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/phong")
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--only", choices=["slurm", "parallel", "make", "kills"])
    args = parser.parse_args()
    install()
    WORK.mkdir(parents=True, exist_ok=True)
    (WORK / "balls.toml").write_text(SCENE)
    (WORK / "floor.toml").write_text(FLOOR)
    parts = {"slurm": slurm, "parallel": parallel, "make": make,
             "kills": lambda phong: kills(phong, args.kills)}
    for name, part in parts.items():
        if name == "slurm" and os.getuid() != 0:
            print("slurm: not tried, since its daemons here need root")
        elif args.only in (None, name):
            began = time.monotonic()
            part(args.program.resolve())
            print(f"{name}: {time.monotonic() - began:.0f} s", flush=True)


if __name__ == "__main__":
    main()
