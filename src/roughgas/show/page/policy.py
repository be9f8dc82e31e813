"""What a page may do, as its content security policy: whatever text gets into it from a file, it
runs no program but its own, and loads nothing."""

import base64
import hashlib

ALWAYS = {
    "default-src": "'none'",
    "style-src": "'unsafe-inline'",
    "img-src": "data: blob:",
    "media-src": "data:",
    "base-uri": "'none'",
    "form-action": "'none'",
}


def policy(*scripts: str) -> str:
    """Return the policy of a page with these inline scripts, each the text between its tags."""
    known = " ".join(f"'sha256-{_digest(script)}'" for script in scripts)
    rules = ALWAYS | ({"script-src": known} if known else {})
    return "; ".join(f"{what} {whence}" for what, whence in rules.items())


def _digest(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
