# SPDX-License-Identifier: MIT
"""A Slurm cluster on this machine: munge, a controller and a daemon for each node, all as the user
who runs this, in a folder of their own and on ports of their own. As a program it sets one up, prints
which environment reaches it, and takes it down when its standard input ends:

    cluster.py FOLDER [NODES]
"""

import getpass
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "scontrol", "sinfo")
# Debian puts daemons in folders that are on root's PATH only.
SEARCHED = os.environ.get("PATH", "") + ":/usr/sbin:/sbin"
LONGEST_WAIT_S = 120

CONFIGURATION = """\
ClusterName=films
SlurmctldHost=localhost
SlurmctldPort={controller_port}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=2
ReturnToService=2
# A node that died is given up after seconds, not minutes.
SlurmdTimeout=5
KillWait=2
JobRequeue=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
PartitionName=films Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def find_missing():
    """The programs of PROGRAMS that are not installed."""
    return [name for name in PROGRAMS if shutil.which(name, path=SEARCHED) is None]


def find_free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


def wait_for(what, condition):
    """Waits until condition() is true. `what` names the condition in the error."""
    end = time.monotonic() + LONGEST_WAIT_S
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"waited {LONGEST_WAIT_S} s for {what}")
        time.sleep(0.2)


def read_bytes(path):
    try:
        return path.read_bytes()
    except OSError:  # the process has ended
        return b""


class Cluster:
    def __init__(self, folder, nodes=2):
        self.folder = Path(folder).resolve()
        self.nodes = [f"node{i + 1}" for i in range(nodes)]
        self.configuration = self.folder / "slurm.conf"
        self.environment = dict(
            os.environ, PATH=SEARCHED, SLURM_CONF=str(self.configuration))

    def run(self, *words, check=True):
        return subprocess.run(words, env=self.environment, capture_output=True, text=True,
                              check=check, timeout=LONGEST_WAIT_S)

    def start(self):
        (self.folder / "state").mkdir(parents=True)
        controller_port, *ports = find_free_ports(1 + len(self.nodes))
        rows = [CONFIGURATION.format(controller_port=controller_port, folder=self.folder,
                                     user=getpass.getuser())]
        rows += [f"NodeName={node} NodeHostname=localhost NodeAddr=127.0.0.1 Port={port} CPUs=1\n"
                 for node, port in zip(self.nodes, ports)]
        self.configuration.write_text("".join(rows))
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        self.run("munged", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                 f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                 f"--seed-file={self.folder}/munged.seed", "--force")
        self.run("slurmctld", "-f", str(self.configuration))
        for node in self.nodes:
            self.start_node(node)
        wait_for("idle nodes", lambda: self.run("sinfo", "-h", "-t", "idle", "-o", "%D",
                                                check=False).stdout.strip() == str(len(self.nodes)))

    def start_node(self, node):
        self.run("slurmd", "-N", node, "-f", str(self.configuration))

    def kill_node(self, node):
        """As if its power failed: the daemon goes first, then what it runs."""
        self.kill(self.folder / f"{node}.pid")
        mark = f"SLURMD_NODENAME={node}".encode()
        ours = f"SLURM_CONF={self.configuration}".encode()
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit():
                continue
            names = read_bytes(entry / "environ").split(b"\0")
            if mark not in names or ours not in names:
                continue
            status = read_bytes(entry / "status").decode(errors="replace")
            parent = next((line.split()[1] for line in status.splitlines()
                           if line.startswith("PPid:")), "")
            if b"slurmstepd" in read_bytes(Path("/proc") / parent / "cmdline"):
                self.kill_process(int(parent))
            self.kill_process(int(entry.name))

    @staticmethod
    def kill_process(process):
        try:
            os.kill(process, signal.SIGKILL)
        except ProcessLookupError:
            pass

    def kill(self, pid_file):
        text = read_bytes(pid_file).strip()
        if text:
            self.kill_process(int(text))

    def stop(self):
        if (self.folder / "slurmctld.pid").exists():
            jobs = self.run("squeue", "-h", "-o", "%A", check=False).stdout.split()
            if jobs:
                self.run("scancel", *jobs, check=False)
        for node in self.nodes:
            self.kill_node(node)
        self.kill(self.folder / "slurmctld.pid")
        self.kill(self.folder / "munged.pid")


def main():
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    missing = find_missing()
    if missing:
        print(f"cluster.py: not installed: {', '.join(missing)} (Debian: slurm-wlm, munge)",
              file=sys.stderr)
        return 77
    cluster = Cluster(sys.argv[1], int(sys.argv[2]) if len(sys.argv) == 3 else 2)
    try:
        cluster.start()
        print(f"export SLURM_CONF={cluster.configuration}", flush=True)
        sys.stdin.read()
    finally:
        cluster.stop()
    return 0


if __name__ == "__main__":
    sys.exit(main())
