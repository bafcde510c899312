"""What a method's file says of itself, read without running it: class attributes that are written out."""
import ast
import hashlib
import importlib.metadata
import json
import os
import pathlib
import re
import site
import sys
import sysconfig

from lgabench_method import installed


class NoMethod(Exception):
    """The file has no such method; one line for a person."""


# Attributes that lgabench reads: of a perturbation, of an environment (as they are, with a default, lists of tuples), of each kind.
_OF_AXIS = ("levels", "changes", "may_change", "named")
_OF_ENVIRONMENT = ("tasks", "failures", "space", "picture", "most_instances")
_DEFAULTS = {"places": [], "rotations": [], "packages": [], "scenario_members": [], "scene_members": [], "network": False,
             "memory_gib": 4, "time_limit_s": 120}
_NUMBER = ("name", "unit", "low", "high")
_TUPLES = {"actions": _NUMBER, "state": _NUMBER, "things": ("object_type", "texture")}
_READ = {"perturbation": {*_OF_AXIS}, "environment": {*_OF_ENVIRONMENT, *_DEFAULTS, *_TUPLES}}
_READ_OF_ALL = {"id", "version", "summary", "asks", "options", "questionnaire"}


def _literals(body):
    """Names that are assigned something written out, in the body of a class, and those that are assigned something else."""
    found, computed = {}, set()
    for statement in body:
        if isinstance(statement, ast.Assign):
            targets, value = statement.targets, statement.value
        elif isinstance(statement, ast.AnnAssign) and statement.value is not None:
            targets, value = [statement.target], statement.value
        else:
            continue
        for target in targets:
            if isinstance(target, ast.Name):
                try:
                    found[target.id] = ast.literal_eval(value)
                except (ValueError, TypeError, SyntaxError):
                    computed.add(target.id)
    return found, computed


def _imports(tree):
    """Top-level modules that the file names anywhere."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names.add(node.module.split(".")[0])
    return names


def _versions(modules):
    """Versions of the distributions that they come from; the interpreter's own modules have its version."""
    owners = importlib.metadata.packages_distributions()
    versions = {"python": ".".join(map(str, sys.version_info[:3]))}
    for module in sorted(modules | {"numpy"}):
        for owner in owners.get(module, []):
            versions[owner] = importlib.metadata.version(owner)
    return versions


def _renderer():
    """The library that draws where MUJOCO_GL or PYOPENGL_PLATFORM chooses one, with its hash; a graphics card's too, by its name.
    Of the system's folders alone: this may run where no program can be started."""
    chosen = os.environ.get("MUJOCO_GL") or os.environ.get("PYOPENGL_PLATFORM")
    name = {"osmesa": "OSMesa", "egl": "EGL", "glfw": "GL", "glx": "GL"}.get((chosen or "").lower())
    folders = ["/usr/local/lib", f"/usr/lib/{sysconfig.get_config_var('MULTIARCH')}", "/usr/lib64", "/usr/lib"]
    for folder in map(pathlib.Path, folders if name else ()):
        if found := sorted(folder.glob(f"lib{name}.so*")):
            library = found[-1].resolve()
            cards = sorted(one.name for one in folder.glob(f"lib{'EGL' if name == 'EGL' else 'GLX'}_nvidia.so.*")) if name != "OSMesa" else []
            return {"renderer": " ".join([library.name, hashlib.sha256(library.read_bytes()).hexdigest()[:16], *cards[-1:]])}
    return {}


def packages(names):
    """Versions of these distributions and of all that they need, as far as they are installed, what chooses a renderer, and the
    renderer."""
    versions, waiting = {"python": ".".join(map(str, sys.version_info[:3]))}, list(names)
    while waiting:
        name = re.sub("[-_.]+", "-", waiting.pop()).lower()
        if name in versions:
            continue
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
        needs = importlib.metadata.requires(name) or []
        waiting += [re.match("[A-Za-z0-9._-]+", need)[0] for need in needs if "extra ==" not in need]
    versions.update({name: os.environ[name] for name in ("MUJOCO_GL", "PYOPENGL_PLATFORM") if name in os.environ})
    return {**versions, **_renderer()}


def _pairs_of(found, name, members):
    """Tuples, each with a value for each of the members, as objects; anything else as it is, for lgabench to refuse."""
    listed = found.get(name, [])
    if not isinstance(listed, (list, tuple)):
        return listed
    return [dict(zip(members, one)) if isinstance(one, (list, tuple)) and len(one) == len(members) else one for one in listed]


def _environment(found, file):
    """What an environment says of itself; lgabench checks it (host/python_environment.cpp)."""
    said = {name: found[name] for name in _OF_ENVIRONMENT if name in found}
    said.update({name: found.get(name, default) for name, default in _DEFAULTS.items()})
    for name, members in _TUPLES.items():
        if name in found or name == "state":
            said[name] = _pairs_of(found, name, members)
    try:
        return json.loads(json.dumps(said, allow_nan=False))
    except (TypeError, ValueError) as error:
        raise NoMethod(f"{file}: expected attributes that JSON has: {error}") from error


def _files(folder, module):
    """What a module of that name in the folder is made of: one file, or all of a package's."""
    file = folder / f"{module}.py"
    return [file] if file.is_file() else sorted(path for path in (folder / module).rglob("*.py") if path.is_file())


def _siblings(folder, tree, seen):
    """Modules in the method's folder that it, or one of them, imports: their hashes are part of what a cell depends on."""
    hashes = {}
    for module in sorted(_imports(tree)):
        for file in _files(folder, module):
            if file.resolve() in seen:
                continue
            seen.add(file.resolve())
            source = file.read_bytes()
            hashes[file.relative_to(folder).as_posix()] = hashlib.sha256(source).hexdigest()
            try:
                own = ast.parse(source, str(file))
            except (SyntaxError, ValueError):
                continue  # the import says where
            hashes.update(_siblings(folder, own, seen))
    return hashes


def _text(found, name, default, file):
    value = found.get(name, default)
    if not isinstance(value, str):
        raise NoMethod(f"{file}: {name}: expected a string literal")
    return value


def _axis(found, file):
    """What a perturbation declares; lgabench checks it."""
    declared = {name: found[name] for name in _OF_AXIS if name in found}
    try:
        return json.loads(json.dumps(declared, allow_nan=False))
    except (TypeError, ValueError) as error:
        raise NoMethod(f"{file}: levels, changes, may_change, named: expected values that JSON has: {error}") from error


def interpreter():
    """This one, and where it reads: asked without a method's file."""
    if sys.version_info < (3, 10):  # importlib.metadata.packages_distributions()
        raise NoMethod(f"Python {sys.version_info[0]}.{sys.version_info[1]}, expected 3.10 or later")
    paths = {path for key, path in sysconfig.get_paths().items() if key in ("stdlib", "platstdlib", "purelib", "platlib")}
    if sys.prefix != sys.base_prefix:
        paths |= {sys.prefix}
    if sys.base_prefix not in ("/usr", "/usr/local"):  # its libraries lie beside it
        paths |= {sys.base_prefix + "/lib"}
    user = site.ENABLE_USER_SITE and pathlib.Path(site.getusersitepackages()).is_dir()  # of pip install --user
    if user:
        paths |= {site.getusersitepackages()}
    return {"interpreter": sys.executable, "reads": sorted(paths), "user_base": site.getuserbase() if user else ""}


def describe(written):
    """Of FILE.py:Class: the descriptor and what it depends on."""
    name, separator, class_name = written.rpartition(":")
    file = pathlib.Path(name)
    if not separator or not class_name.isidentifier():
        raise NoMethod(f"{written}: expected FILE.py:Class")
    try:
        source = file.read_bytes()
        tree = ast.parse(source, str(file))
    except OSError as error:
        raise NoMethod(f"{file}: cannot be read: {error.strerror}") from error
    except (SyntaxError, ValueError) as error:
        raise NoMethod(f"{file}: {error}") from error
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    if class_name not in classes:
        raise NoMethod(f"{file}: no class {class_name}, it has: {', '.join(classes) or 'none'}")
    found, computed = _literals(classes[class_name].body)
    real = file.resolve()  # where it runs and imports from: a link's own folder has nothing to do with it
    options = found.get("options", {})
    if not isinstance(options, dict):
        raise NoMethod(f"{file}: options: expected a dictionary literal")
    try:
        json.dumps(options, allow_nan=False, sort_keys=True)
    except (TypeError, ValueError) as error:
        raise NoMethod(f"{file}: options: expected values that JSON has: {error}") from error
    site_packages = installed.site_of(real)
    own = {installed.module_of(site_packages, real).partition(".")[0]} if site_packages else set()
    beside = ({path.relative_to(site_packages).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
               for path in installed.files_of(site_packages, real)} if site_packages else _siblings(real.parent, tree, {real}))
    declares = found.get("questionnaire", False)
    if not isinstance(declares, bool):
        raise NoMethod(f"{file}: questionnaire: expected True or False")
    functions = {node.name for node in classes[class_name].body if isinstance(node, ast.FunctionDef)}
    kind = "environment" if {"reset", "step"} <= functions else "perturbation" if "perceive" in functions else "perceiver" if "read" in functions else "method"
    for name in sorted(computed & (_READ_OF_ALL | _READ.get(kind, set()))):
        raise NoMethod(f"{file}: {name}: expected a literal, which can be read without running the file")
    said = _environment(found, file) if kind == "environment" else None
    names = said["packages"] if said else []
    if not isinstance(names, list) or not all(isinstance(name, str) for name in names):
        raise NoMethod(f"{file}: packages: expected names of distributions")
    return {"file": str(real), "class": class_name, "kind": kind, "axis": _axis(found, file) if kind == "perturbation" else None,
            "id": _text(found, "id", file.stem, file), "version": _text(found, "version", "0", file),
            "summary": _text(found, "summary", (ast.get_docstring(classes[class_name]) or "").split("\n")[0], file),
            "asks": _text(found, "asks", "", file), "options": options,
            "questionnaire": declares,
            "selects_alone": kind == "method" and "learn" not in functions and not classes[class_name].bases,
            "sha256": hashlib.sha256(source).hexdigest(),
            "environment": said, "versions": {**_versions(_imports(tree) | own), **(packages(names) if said else {}), **beside}}
