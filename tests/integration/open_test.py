"""lgabench open: a report in a browser, and the page over all runs."""
import contextlib
import http.client
import signal
import socket
import subprocess
import time
import unittest

from case import Case, FIXTURES, command_line

RUN = ("run", "q1", "--scenarios", "heart", "--methods", "fixture_constant", "--plugin-path", FIXTURES / "good", "--demos", "2",
       "--seeds", "0:2", "--episodes", "2", "--no-reference")


class OpenedRuns(Case):
    def setUp(self):
        super().setUp()
        for variable in "BROWSER", "DISPLAY", "WAYLAND_DISPLAY":
            self.environment.pop(variable, None)

    def with_browser(self):
        """A browser that keeps what it is asked to show."""
        browser = self.dir / "browser"
        browser.write_text(f'#!/bin/sh\nprintf %s "$1" > {self.dir}/shown.part\nmv {self.dir}/shown.part {self.dir}/shown\n')
        browser.chmod(0o755)
        self.environment["BROWSER"] = str(browser)

    def shown(self):
        for _ in range(100):
            if (self.dir / "shown").exists():
                return (self.dir / "shown").read_text()
            time.sleep(.1)
        self.fail("no browser was started")

    def serve(self, *where):
        self.server = subprocess.Popen(command_line("open", *where), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                       env=self.environment, cwd=self.dir)
        self.addCleanup(self.stop)
        self.address = self.server.stdout.readline().split()[0]
        self.port = int(self.address.rsplit(":", 1)[1].strip("/"))

    def stop(self):
        if self.server.poll() is None:
            self.server.send_signal(signal.SIGINT)
            self.server.wait(30)
        with self.server:
            return self.server.returncode, self.server.stderr.read() if not self.server.stderr.closed else ""

    def ask(self, path, method="GET", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return answer.status, answer.headers, text

    def test_a_report(self):
        self.call(*RUN, "--out", "run")
        page = self.dir / "run/report.html"
        self.assertEqual(self.call("open", "run").stdout, f"{page}\n")
        page.unlink()
        self.with_browser()
        self.call("open", "run")
        self.assertEqual(self.shown(), str(page))
        self.assertTrue(page.is_file(), "it is made where it was missing")
        self.assertIn("nowhere: not the directory of a run", self.call("open", "nowhere", expect=2).stderr)

    def test_all_runs_while_they_compute(self):
        self.call(*RUN, "--out", "runs/my_first")
        self.with_browser()
        self.serve()
        self.assertEqual(self.shown(), self.address)
        status, headers, page = self.ask("/")
        self.assertEqual((status, headers["Refresh"]), (200, None))
        self.assertIn('<a href="my_first/report.html"><code>my_first</code></a>', page, "as the folder is called")
        self.assertRegex(page, r"2 of 2.*finished")
        self.assertEqual(self.ask("/my_first/report.html")[2], (self.dir / "runs/my_first/report.html").read_text())

        busy = self.start("run", "q1", "--scenarios", "heart", "--methods", "fixture_faulty+where=act+how=spin", "--plugin-path",
                          FIXTURES / "faulty", "--demos", "2", "--seeds", "0", "--no-reference", "--out", "runs/part/second")
        self.addCleanup(busy.wait)
        self.addCleanup(busy.terminate)
        for _ in range(300):
            status, headers, page = self.ask("/")
            if "computing" in page:
                break
            time.sleep(.1)
        self.assertIn("part/second", page)
        self.assertNotIn('href="part/second', page, "it has no report yet")
        self.assertEqual(headers["Refresh"], "3")
        self.assertEqual(self.stop(), (0, ""))

    def test_nothing_else_is_served(self):
        self.call(*RUN, "--out", "runs/my_first")
        (self.dir / "secret").write_text("a secret")
        (self.dir / "runs/elsewhere").symlink_to(self.dir)
        (self.dir / "runs/second").mkdir()
        for name in "run.json", "report.html":
            (self.dir / "runs/second" / name).symlink_to(self.dir / "secret")
        (self.dir / "runs/broken").mkdir()
        (self.dir / "runs/broken/run.json").write_text("{")
        self.serve("runs")
        page = self.ask("/")[2]
        self.assertRegex(page, "broken.*run.json")
        for path in ("/my_first/run.json", "/my_first/", "/my_first", "/../secret", "/my_first/../../secret", "/%2e%2e/secret", "/second/report.html",
                     "/elsewhere/secret", f"/{self.dir}/secret", "/my_first/report.html/", "//my_first/report.html", "/broken/report.html"):
            status, headers, text = self.ask(path)
            self.assertIn(status, (404, 500), path)
            self.assertNotIn("a secret", text, path)
            self.assertIn("default-src 'none'", headers["Content-Security-Policy"], path)
        for method in "POST", "PUT", "DELETE", "OPTIONS":
            self.assertEqual(self.ask("/", method)[0], 405, method)
        for host, status in ((f"localhost:{self.port}", 200), ("rebound.example", 421), (f"rebound.example:{self.port}", 421)):
            self.assertEqual(self.ask("/my_first/report.html", Host=host)[0], status, host)
        with socket.create_connection(("127.0.0.1", self.port), timeout=5) as endless:  # a head without end
            endless.sendall(f"GET / HTTP/1.1\r\nHost: localhost:{self.port}\r\n".encode())
            with contextlib.suppress(OSError):
                for _ in range(100):
                    endless.sendall(b"X-More: " + b"x" * 8000 + b"\r\n")
            endless.settimeout(60)
            said = b""
            with contextlib.suppress(ConnectionError):
                while part := endless.recv(1 << 16):
                    said += part
            self.assertNotIn(b"200 OK", said)


if __name__ == "__main__":
    unittest.main(verbosity=2)
