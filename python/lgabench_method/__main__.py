"""python -m lgabench_method FILE.py:Class describes a method as JSON on stdout, without running it.

lgabench does the rest: with --serve, on a socket as descriptor 3, this is the process that the method runs in.
"""
import faulthandler
import json
import os
import socket
import sys


def main(words):
    if words == ["--serve"]:
        faulthandler.enable()  # a crash in a library leaves a traceback in the log
        from lgabench_method import frames, serve
        channel = frames.Channel(socket.socket(fileno=3))
        try:
            serve.serve(channel)
        except OSError:
            if channel.is_open():
                raise
            os._exit(97)  # the worker says then what that means (host/last_words.hpp)
        sys.stdout.flush()
        os._exit(0)  # all was said: what a library does at exit can neither help nor harm any more
    asks_where = words == ["--interpreter"]  # it reads, too
    if len(words) != 1 or words[0].startswith("-") and not asks_where:
        print(__doc__.splitlines()[0], file=sys.stderr)
        return 2
    from lgabench_method import describe
    try:
        print(json.dumps(describe.interpreter() if asks_where else describe.describe(words[0]), sort_keys=True))
    except describe.NoMethod as error:
        print(error, file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
