#!/usr/bin/env bash
# slurm_cluster.sh FOLDER COMMAND [ARGUMENT…]
#
# Runs a command on a Slurm cluster of its own: controller and one node of two processors on the loopback address, with
# everything they write in FOLDER, ended with the command. Exit status 77, with the reason on stderr, where Slurm is not
# installed or cannot start; otherwise the command's.
set -uo pipefail
folder=$1
shift
PATH=$PATH:/usr/sbin:/sbin

skip() {
  echo "no Slurm here: $*" >&2
  exit 77
}

for program in munged slurmctld slurmd sbatch scontrol; do
  command -v "$program" >/dev/null || skip "$program is not installed (Debian: slurm-wlm, munge)"
done

children=()
stop() {
  local child
  for child in "${children[@]}"; do kill "$child" 2>/dev/null; done
  for child in "${children[@]}"; do
    for _ in {1..50}; do
      kill -0 "$child" 2>/dev/null || break
      sleep 0.1
    done
    kill -9 "$child" 2>/dev/null
  done
  wait
}
trap stop EXIT

free_port() {
  local port
  while port=$((20000 + RANDOM % 12000)); do
    (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null || break
  done
  echo "$port"
}

# wait_for SECONDS COMMAND…
wait_for() {
  local tries=$(($1 * 10))
  shift
  for ((i = 0; i < tries; ++i)); do
    "$@" >/dev/null 2>&1 && return
    sleep 0.1
  done
  return 1
}

mkdir -p "$folder"/{state,spool}
dd if=/dev/urandom of="$folder/munge.key" bs=128 count=1 status=none
chmod 400 "$folder/munge.key"
# --force: the folder is not root's alone.
munged --foreground --force --num-threads=1 --socket="$folder/munge.socket" --key-file="$folder/munge.key" \
  --pid-file="$folder/munged.pid" --seed-file="$folder/munged.seed" --log-file="$folder/munged.log" &>"$folder/munged.out" &
children+=($!)
wait_for 15 test -S "$folder/munge.socket" || skip "munged does not start: $(tail -n 1 "$folder/munged.out")"

cat >"$folder/slurm.conf" <<END
ClusterName=lightgrid
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=batch_sched_delay=0,sched_min_interval=10000,build_queue_timeout=1000000
ReturnToService=2
RebootProgram=/bin/true
InactiveLimit=0
KillWait=1
NodeName=node NodeHostname=localhost NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=node Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
slurmctld -D &>"$folder/slurmctld.out" &
children+=($!)
wait_for 30 scontrol ping || skip "slurmctld does not start: $(tail -n 1 "$folder/slurmctld.log" "$folder/slurmctld.out" 2>&1)"
slurmd -D -N node &>"$folder/slurmd.out" &
children+=($!)
is_idle() { scontrol -o show node node | grep -q 'State=IDLE '; }
wait_for 30 is_idle || skip "slurmd does not start: $(tail -n 1 "$folder/slurmd.log" "$folder/slurmd.out" 2>&1)"

"$@"
