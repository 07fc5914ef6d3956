"""Users, queries and keys: who sees them, and who must not."""
import hashlib
import hmac
import os
import re

from case import RemoteTest, SECRET
from server import Server


def signature(request):
    """AWS Signature Version 4 of a request without a body, from its headers."""
    headers = {name.lower(): value.strip() for name, value in request.headers.items()}
    scope, signed = re.search(r"Credential=[^/]*/([^,]*), SignedHeaders=([^,]*)", headers["authorization"]).groups()
    path, _, query = request.path.partition("?")
    lines = [request.method, path, query, *(f"{name}:{headers[name]}" for name in signed.split(";")), "", signed,
             headers["x-amz-content-sha256"]]
    hashed = hashlib.sha256("\n".join(lines).encode()).hexdigest()
    key = f"AWS4{SECRET}".encode()
    for word in scope.split("/"):
        key = hmac.digest(key, word.encode(), "sha256")
    text = f"AWS4-HMAC-SHA256\n{headers['x-amz-date']}\n{scope}\n{hashed}"
    return hmac.digest(key, text.encode(), "sha256").hex()


class Secrets(RemoteTest):
    def expect_no_secret(self):
        """In no file of the folder, beside what is served."""
        for folder, _, names in os.walk(self.folder):
            for name in names:
                with open(f"{folder}/{name}", "rb") as file:
                    self.assertNotIn(SECRET.encode(), file.read(), name)

    def test_users_and_queries_go_to_the_server_alone(self):
        host = self.server.url.removeprefix("http://")
        url = f"http://ann:{SECRET}@{host}/zarr2?sig={SECRET}#{SECRET}"
        process, digest = self.mesh(url)
        self.assertEqual(digest, self.digest(f"{self.served}/zarr2"), process.stderr)
        self.mesh(url)
        self.assertTrue(all(path.endswith(f"?sig={SECRET}") for path in self.server.asked()))
        self.assertTrue(all("Basic " in r.headers["Authorization"] for r in self.server.requests))
        self.expect_no_secret()
        info = self.run_isoweave("info", url)
        self.fail_at("/0.0.0", "status", status=403)
        refused, _ = self.mesh(url)
        coloured, _ = self.mesh(f"{self.served}/zarr2", "--color-by", url)
        kept = self.run_isoweave("mesh", url, "--iso", "100", "-o", "k.ply", "--checkpoint", "saved")
        planned = self.run_isoweave("plan", url, "--iso", "100", "-o", "tasks")
        for run, code in ((process, 0), (info, 0), (refused, 3), (coloured, 3), (kept, 2), (planned, 2)):
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertNotIn(SECRET, run.stdout + run.stderr)
        self.expect_no_secret()

    def s3(self, **more):
        self.environment.update(AWS_ENDPOINT_URL=self.server.url, **more)

    def test_s3_is_asked_as_anybody_without_keys(self):
        self.s3()
        self.assertEqual(self.digest("s3://zarr2"), self.digest(f"{self.served}/zarr2"))
        self.assertFalse(any("Authorization" in r.headers for r in self.server.requests))
        self.fail_at("/0.0.0", "status", status=403)
        self.expect_refused("s3://zarr2", "isoweave: s3://zarr2/0.0.0: ", "found status 403, unsigned: AWS_ACCESS_KEY_ID")

    def test_s3_requests_are_signed(self):
        self.s3(AWS_ACCESS_KEY_ID="AKEXAMPLE", AWS_SECRET_ACCESS_KEY=SECRET, AWS_SESSION_TOKEN="token" + SECRET,
                AWS_REGION="eu-north-1")
        os.rename(f"{self.served}/shards", f"{self.served}/zarr2/a +%&b")
        process, digest = self.mesh("s3://zarr2")
        self.assertEqual(digest, self.digest(f"{self.served}/zarr2"), process.stderr)
        self.assertEqual(self.digest("s3://zarr2/a +%&b"), digest)
        for request in self.server.requests:
            self.assertRegex(request.headers["Authorization"],
                             r"^AWS4-HMAC-SHA256 Credential=AKEXAMPLE/\d{8}/eu-north-1/s3/aws4_request, "
                             r"SignedHeaders=[a-z0-9;-]*host[a-z0-9;-]*x-amz-date[a-z0-9;-]*, Signature=[0-9a-f]{64}$")
            self.assertNotIn(SECRET, request.headers["Authorization"])
            self.assertTrue(request.headers["Authorization"].endswith("=" + signature(request)), request)
            self.assertEqual(request.headers["x-amz-security-token"], "token" + SECRET)
        self.mesh("s3://zarr2")
        self.fail_at("/0.0.0", "status", status=403)
        refused, _ = self.mesh("s3://zarr2")
        self.assertEqual(refused.returncode, 3)
        self.assertNotIn(SECRET, process.stderr + process.stdout + refused.stderr)
        self.expect_no_secret()

    def test_a_signed_request_follows_no_redirect(self):
        self.s3(AWS_ACCESS_KEY_ID="AKEXAMPLE", AWS_SECRET_ACCESS_KEY=SECRET)
        elsewhere = Server(self.served)
        self.addCleanup(elsewhere.close)
        self.fail_at("/0.0.0", "status", status=307, headers={"Location": f"{elsewhere.url}/zarr2/0.0.0"})
        self.expect_refused("s3://zarr2", "found status 307")
        self.assertEqual(elsewhere.requests, [])

    def test_s3_buckets_that_may_not_be_listed(self):
        """They answer 403 for objects that they lack: no reason to give up while metadata are looked for."""
        self.s3()
        for name in ("zarr.json", ".zattrs", ".zgroup", "attributes.json"):
            self.fail_at(name, "status", status=403)
        self.assertEqual(self.digest("s3://zarr2"), self.digest(f"{self.served}/zarr2"))
        self.fail_at("nothing/", "status", status=403)
        self.fail_at("", "status", status=403)
        self.expect_refused("s3://nothing", "expected the metadata of ", "found status 403")

    def test_a_redirect_takes_no_user_to_another_server(self):
        elsewhere = Server(self.served)
        self.addCleanup(elsewhere.close)
        self.fail_at("/0.0.0", "status", status=302, headers={"Location": f"{elsewhere.url}/zarr2/0.0.0"})
        host = self.server.url.removeprefix("http://")
        self.digest(f"http://ann:{SECRET}@{host}/zarr2")
        self.assertEqual({r.headers.get("Authorization") for r in elsewhere.requests}, {None})

    def test_gs_shows_its_token_to_the_service_alone(self):
        self.environment.update(STORAGE_EMULATOR_HOST=self.server.url.removeprefix("http://"))
        self.assertEqual(self.digest("gs://zarr2"), self.digest(f"{self.served}/zarr2"))
        self.assertFalse(any("Authorization" in r.headers for r in self.server.requests))
        self.server.requests.clear()
        self.environment["GOOGLE_OAUTH_ACCESS_TOKEN"] = SECRET
        process, _ = self.mesh("gs://zarr2")
        self.assertEqual({r.headers["Authorization"] for r in self.server.requests}, {"Bearer " + SECRET})
        self.assertNotIn(SECRET, process.stdout + process.stderr)
        self.expect_no_secret()
