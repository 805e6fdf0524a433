"""Gives the content of a passport if OpenSSH verifies it; what that leaves open is in verifying.md. Needs PyYAML and ssh-keygen."""
import re, subprocess, sys, tempfile
import yaml

# The signed bytes, then the armored signature, then nothing.
FORM = (rb"(.*\n)signature: \|\n"
        rb"(  -----BEGIN SSH SIGNATURE-----\n(?:  [A-Za-z0-9+/=]+\n)+  -----END SSH SIGNATURE-----\n)")


def verified(path, signers, issuer):
    """Returns what `issuer` signed. Only the signed bytes are parsed, and only after the signature holds."""
    form = re.fullmatch(FORM, open(path, "rb").read(), re.S)
    issued_at = form and re.search(rb'^  issued_at: "(\d{4})-(\d\d)-(\d\d)T(\d\d):(\d\d):(\d\d)Z"$', form[1], re.M)
    if not issued_at:
        sys.exit(f"{path}: refused: not a signed passport, or something follows the signature")
    with tempfile.NamedTemporaryFile() as signature:
        signature.write(form[2].replace(b"  ", b""))
        signature.flush()
        check = subprocess.run(
            ["ssh-keygen", "-Y", "verify", "-f", signers, "-I", issuer, "-n", "dtg-passport",
             "-O", f"verify-time={b''.join(issued_at.groups()).decode()}Z", "-s", signature.name],
            input=form[1], capture_output=True)
    if check.returncode != 0:
        sys.exit(f"{path}: refused: no valid signature of {issuer}: {(check.stderr + check.stdout).decode(errors='replace').strip()}")
    content = yaml.safe_load(form[1])
    if content["format"] != "dtg-passport/1" or content["passport"]["issuer"] != issuer:
        sys.exit(f"{path}: refused: not a passport that says it is from {issuer}")
    return content
