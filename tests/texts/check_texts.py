#!/usr/bin/env python3
"""Compiles all kernels and shaders in the variants of variants.txt, with clang and glslangValidator.

usage: check_texts.py FOLDER    (of write_texts)

Prints the first errors of each text that does not compile, and each text that an effect changes without being used: one
that differs, after the preprocessor, from the text of a program without the effect. A compiler that is missing is
skipped, by name.
"""

import concurrent.futures
import fnmatch
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

CLANG_FLAGS = ["-x", "cl", "-cl-std=CL1.2", "-Xclang", "-fdeclare-opencl-builtins", "-Xclang",
               "-finclude-default-header", "-D__OPENCL_VERSION__=120", "-fsyntax-only", "-w"]


def variants():
    """Lists the pairs of a pattern and its defines; a pattern of several lines has several variants."""
    for line in (pathlib.Path(__file__).parent / "variants.txt").read_text().splitlines():
        pattern, _, defines = line.partition(":")
        if pattern and not pattern.startswith("#"):
            yield pattern.strip(), defines.split()


def found(*names):
    """Returns the first of these programs that is installed, or none."""
    return next((name for name in names if shutil.which(name)), None)


CLANG_PROGRAM = found("clang", *(f"clang-{n}" for n in range(20, 13, -1)))
GLSLANG = found("glslangValidator", "glslang")


def errors_of_kernel(path, defines):
    flags = [] if "PORTABLE" in defines else ["-march=x86-64-v4"] if os.uname().machine == "x86_64" else []
    run = subprocess.run([CLANG_PROGRAM, *CLANG_FLAGS, *flags, *("-D" + d for d in defines), path], capture_output=True, text=True)
    return run.stderr if run.returncode else ""


def errors_of_shader(path, defines):
    with tempfile.NamedTemporaryFile("w", suffix=path.suffix) as file:
        file.write("#version 450 core\n#define LIGHTGRID_GLSL\n")
        file.writelines("#define " + d.replace("=", " ") + "\n" for d in defines)
        file.write(path.read_text())
        file.flush()
        run = subprocess.run([GLSLANG, file.name], capture_output=True, text=True)
    return run.stdout if run.returncode else ""


def preprocessed(path, defines):
    """Returns what the compiler reads, without white space. The clang preprocessor serves for shaders too."""
    flags = [*CLANG_FLAGS[:3], "-D__OPENCL_VERSION__=120"] if path.suffix == ".cl" else ["-x", "c", "-DLIGHTGRID_GLSL"]
    run = subprocess.run([CLANG_PROGRAM, *flags, "-E", "-P", "-w", *("-D" + d for d in defines), path], capture_output=True, text=True)
    return "".join(run.stdout.split())


def changed_by(effect, folder, jobs, pool):
    """Lists the texts that do not use the effect and differ without its files; returns the number compared."""
    pairs = [(name, defines, path, folder / "without" / effect / name) for name, defines, _, path in jobs
             if "EFFECT_" + effect.upper() not in defines]
    pairs = [p for p in pairs if p[3].exists() and p[2].read_bytes() != p[3].read_bytes()]
    same = pool.map(lambda p: preprocessed(p[2], p[1]) == preprocessed(p[3], p[1]), pairs)
    return [pair[:2] for pair, equal in zip(pairs, same) if not equal], len(pairs)


def main():
    folder = pathlib.Path(sys.argv[1])
    rows = list(variants())
    jobs = []
    without = folder / "without"
    for path in sorted(p for p in folder.rglob("*") if p.is_file() and without not in p.parents):
        kernel = path.suffix == ".cl"
        if not (CLANG_PROGRAM if kernel else GLSLANG):
            continue
        name = str(path.relative_to(folder))
        own = [defines for pattern, defines in rows if fnmatch.fnmatch(name, pattern)]
        for defines in own or [[]]:
            jobs.append((name, defines, errors_of_kernel if kernel else errors_of_shader, path))
    for texts, program, package in ("kernels", CLANG_PROGRAM, "clang"), ("shaders", GLSLANG, "glslang-tools"):
        if not program:
            print(f"{texts} are not checked: install {package}")
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (name, defines, *_), errors in zip(jobs, pool.map(lambda job: job[2](job[3], job[1]), jobs)):
            if errors:
                failed += 1
                print(name, *defines)
                print(*[line for line in errors.splitlines() if "error" in line.lower()][:3], sep="\n")
        for effect in sorted(p.name for p in without.iterdir()) if CLANG_PROGRAM else []:
            changed, compared = changed_by(effect, folder, jobs, pool)
            failed += len(changed)
            for name, defines in changed:
                print(name, *defines, f"is changed by {effect}, which it does not use")
            print(f"{effect}: {compared - len(changed)} of {compared} texts that include effects and not this one are the same without it")
    print(f"{len(jobs)} texts, {failed} faults")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
