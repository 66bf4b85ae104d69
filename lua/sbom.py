#!/usr/bin/env python3
# SPDX-FileCopyrightText: the aib authors
# SPDX-License-Identifier: MIT
"""Writes what aib-lua was built from as an SPDX 2.3 document: sbom.py VERSION LICENCES NAME=VERSION...

LICENCES is the text beside the page's script, whose libraries are in it as "name version, licence".
The same libraries give the same bytes: the date is that of SOURCE_DATE_EPOCH, 1970 without it.
"""
import datetime
import json
import os
import pathlib
import re
import sys

LICENSES = {
    "eigen3": "MPL-2.0",
    "libdeflate": "MIT",
    "libedit": "BSD-3-Clause",
    "libjpeg": "IJG AND BSD-3-Clause AND Zlib",
    "lua": "MIT",
    "nanoflann": "BSD-2-Clause",
    "nlohmann_json": "MIT",
    "pugixml": "MIT",
    "sol2": "MIT",
    "spng": "BSD-2-Clause",
    "zlib": "Zlib",
}


def package(name, version, license_name):
    return {
        "SPDXID": f"SPDXRef-{name.replace('_', '-')}",
        "name": name,
        "versionInfo": version,
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": license_name,
        "licenseDeclared": license_name,
        "copyrightText": "NOASSERTION",
    }


def page_packages(licences):
    text = pathlib.Path(licences).read_text(encoding="utf-8")
    found = re.findall(r"^(\S+) (\d\S*), (\S+)$", text, re.MULTILINE)
    return [package(name, version, license_name) for name, version, license_name in found]


def main(version, licences, *libraries):
    epoch = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    created = datetime.datetime.fromtimestamp(epoch, datetime.timezone.utc)
    packages = [package("aib-lua", version, "MIT")]
    for library in libraries:
        name, _, found = library.partition("=")
        packages.append(package(name, found, LICENSES[name]))
    packages += page_packages(licences)
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-aib-lua")]
    relations += [("SPDXRef-aib-lua", "DEPENDS_ON", p["SPDXID"]) for p in packages[1:]]
    document = {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"aib-lua-{version}",
        "documentNamespace": f"urn:aib:spdx:aib-lua-{version}",
        "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: aib sbom.py"]},
        "packages": packages,
        "relationships": [
            {"spdxElementId": a, "relationshipType": how, "relatedSpdxElement": b} for a, how, b in relations
        ],
    }
    print(json.dumps(document, indent=2))


main(*sys.argv[1:])
