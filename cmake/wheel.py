"""Packs a build tree as a wheel that needs no library but glibc's and libstdc++: wheel.py BUILD OUT (./wheel calls it)."""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
SYSTEM = re.compile(r"(ld-linux|libc|libm|libdl|librt|libpthread|libutil|libresolv|libanl|libstdc\+\+|libgcc_s)(?=[.-])")
# What needs LibTorch would be 440 MB more.
LIBTORCHS = ("lib/lgabench/plugins/diffusion.so", "lib/liblgabench_encoder.so", "share/lgabench/encoder")
LEFT_OUT = (*LIBTORCHS, "include", "lib/cmake", "share/doc", "bin/lgabench-engine-conformance")
# OpenCV's core library links BLAS and LAPACK, and nothing here calls them: the reference ones are 10 MB smaller than OpenBLAS.
REFERENCE_BLAS = ("/usr/lib/x86_64-linux-gnu/blas", "/usr/lib/x86_64-linux-gnu/lapack")
DESCRIPTION = """A benchmark of language-guided abstraction: scenes to step, as Gymnasium environments too, and the command line.

`import lgabench, gymnasium; env = gymnasium.make("lgabench/heart-v1")`, `python -m lgabench run q1 --preset smoke`;
docs/python.md in the repository says the rest."""

ENTRY_POINTS = """[console_scripts]
lgabench = lgabench.__main__:main

[inspect_ai]
lgabench = lgabench.inspect_tasks
"""


def run(*words):
    return subprocess.run(list(map(str, words)), check=True, capture_output=True, text=True).stdout


def is_elf(path):
    return path.is_file() and not path.is_symlink() and path.read_bytes()[:4] == b"\x7fELF"


def needed(path):
    """Soname -> file of every library that a program or library loads, the system's own ones excepted."""
    found = re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", path), re.M)
    return {name: pathlib.Path(file) for name, file in found if not SYSTEM.match(name)}


def copy_package(build, root):
    install = root / "lgabench/_install"
    run("cmake", "--install", build, "--prefix", install)
    shutil.move(install / "share/doc/lgabench/licenses", root.parent / "licenses")
    for name in LEFT_OUT:
        path = install / name
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    for file in sorted((build / "python/lgabench").iterdir()):
        if file.name not in ("_install", "__pycache__"):
            shutil.copy(file, root / "lgabench")
    for package in ("lgabench_method", "lgabench_environment"):
        shutil.copytree(SOURCE / "python" / package, root / package, ignore=shutil.ignore_patterns("__pycache__"))
    return install


def write_about(root, version, tag):
    about = root / f"lgabench-{version}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"""Metadata-Version: 2.1
Name: lgabench
Version: {version}
Summary: {DESCRIPTION.splitlines()[0]}
License: Apache-2.0
Requires-Python: ==3.{sys.version_info.minor}.*
Requires-Dist: numpy
Provides-Extra: gym
Requires-Dist: gymnasium>=1.1; extra == "gym"
Provides-Extra: data
Requires-Dist: pandas; extra == "data"
Requires-Dist: h5py; extra == "data"

{DESCRIPTION}
""")
    (about / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: lgabench\nRoot-Is-Purelib: false\nTag: {tag}\n")
    (about / "entry_points.txt").write_text(ENTRY_POINTS)
    return about


def licences_of(libraries, about):
    """Each library's terms, as Debian's package of it states them, beside those of what is compiled in."""
    folder = about / "licenses"
    folder.mkdir(exist_ok=True)
    shutil.copy(SOURCE / "LICENSE", folder / "LICENSE")
    for name, file in sorted(libraries.items()):
        paths = [file, file.resolve()]
        paths += [pathlib.Path("/usr", *path.parts[1:]) if path.parts[1] == "lib" else pathlib.Path("/", *path.parts[2:])
                  for path in paths]  # /lib is /usr/lib, and packages name either
        for path in paths:
            if owner := subprocess.run(["dpkg", "-S", path], capture_output=True, text=True).stdout.split(":")[0]:
                break
        else:
            sys.exit(f"{file}: no Debian package holds it, so that its licence is unknown")
        (folder / owner).mkdir(exist_ok=True)
        shutil.copy(f"/usr/share/doc/{owner}/copyright", folder / owner / "copyright")


def pack(root, about, wheel):
    """The names, sizes and hashes of all files are the wheel's last one."""
    record = about / "RECORD"
    files = sorted(path for path in root.rglob("*") if path.is_file() and path != record)
    lines = []
    for path in files:
        digest = base64.urlsafe_b64encode(hashlib.sha256(path.read_bytes()).digest()).rstrip(b"=").decode()
        lines.append(f"{path.relative_to(root).as_posix()},sha256={digest},{path.stat().st_size}\n")
    record.write_text("".join(lines) + f"{record.relative_to(root).as_posix()},,\n")
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for path in [*files, record]:
            archive.write(path, path.relative_to(root))


def main(build, out):
    os.environ["LD_LIBRARY_PATH"] = ":".join(REFERENCE_BLAS)
    said = re.search(r'LGABENCH_VERSION "(.*)"', (SOURCE / "framework/lgabench/core/version.hpp").read_text())[1]
    version = said.replace("-dev", ".dev0")  # as PyPI's rules write it
    tag = f"cp3{sys.version_info.minor}"
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        root = work / "tree"
        install = copy_package(build, root)
        own = [path for path in root.rglob("*") if is_elf(path)]
        libraries = {name: file for path in own for name, file in needed(path).items()
                     if root not in file.resolve().parents}
        for path in own:
            run("strip", "--strip-unneeded", path)
        about = write_about(root, version, f"{tag}-{tag}-linux_x86_64")
        shutil.move(work / "licenses", about / "licenses")
        licences_of(libraries, about)
        wheel = work / f"lgabench-{version}-{tag}-{tag}-linux_x86_64.whl"
        pack(root, about, wheel)
        run(sys.executable, "-m", "auditwheel", "repair", "-L", "/_install/lib", "-w", work / "repaired", wheel)
        repaired = next((work / "repaired").glob("*.whl"))

        # What manylinux leaves to the system a container may lack: libX11, which OpenCV's core library links, and zlib.
        shutil.rmtree(root)
        with zipfile.ZipFile(repaired) as archive:
            for member in archive.infolist():
                (root / archive.extract(member, root)).chmod(member.external_attr >> 16 or 0o644)
        lib = root / "lgabench/_install/lib"
        while left := {name: libraries[name] for path in root.rglob("*") if is_elf(path) for name, file in needed(path).items()
                       if root not in file.parents}:
            for name, file in left.items():
                shutil.copy(file, lib / name)
            for path in filter(is_elf, lib.iterdir()):
                if "$ORIGIN" not in run("patchelf", "--print-rpath", path):
                    run("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", path)
        out.mkdir(parents=True, exist_ok=True)
        final = out / repaired.name
        pack(root, next(root.glob("*.dist-info")), final)
    print(f"{final} ({final.stat().st_size / 1e6:.0f} MB); pip install '{final}[gym,data]'")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
