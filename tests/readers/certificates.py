"""Checks Digital Calibration Certificates with PTB's programs and reads them with PyDCC; prints JSON.

Usage: certificates.py [--xsd FOLDER] FILE...  FOLDER has PTB's schemas as v3.3.0/dcc.xsd, with relative schemaLocations.
"""

import json
import re
import struct
import sys

from lxml import etree

# PyDCC needs oscrypto, which does not understand versions of OpenSSL with two digits in a part, such as 3.0.17.
search = re.search
re.search = lambda pattern, *rest: search(
    pattern.replace(r"\d\.\d\.\d[a-z]*", r"\d+\.\d+\.\d+[a-z]*") if isinstance(pattern, str) else pattern, *rest
)
import dcc.dcc as pydcc

re.search = search
# PyDCC downloads all schemas at every start; nothing here uses them.
pydcc.DCCXMLValidator = lambda: None

import dsi_unit
from dcclib.validation import SchematronValidator

SI = "{https://ptb.de/si}"


def numbers(text):
    """Returns the bits of each number in hexadecimal."""
    return [struct.pack(">d", float(number)).hex() for number in text.split()]


def uncertainty(value):
    found = value.get("measurementUncertaintyUnivariateXMLList", {}).get("standardMUXMLList")
    if found:
        return numbers(found["valueStandardMUXMLList"])
    found = value.get("measurementUncertaintyUnivariate", {}).get("standardMU")
    return numbers(found["valueStandardMU"]) if found else None


def quantity(name, value):
    ((kind, value),) = value.items()
    text, unit = ("valueXMLList", "unitXMLList") if kind == "realListXMLList" else ("value", "unit")
    return {"name": name.strip(), "values": numbers(value[text]), "unit": value[unit], "u": uncertainty(value)}


def findings(schematron, document):
    report = schematron.validate_tree(document)
    every = report.failed_assertions + report.successful_reports
    return len(every), [str(found) for found in every if found.role in ("error", "warning")]


def schema_errors(schema, document):
    """Returns None without a schema."""
    if schema is None:
        return None
    return [] if schema.validate(document) else [str(error) for error in schema.error_log]


def main(arguments):
    schema = None
    parser = etree.XMLParser(resolve_entities=False, no_network=True)
    if arguments[0] == "--xsd":
        schema = etree.XMLSchema(etree.parse(f"{arguments[1]}/v3.3.0/dcc.xsd", parser))
        arguments = arguments[2:]
    schematron = SchematronValidator.for_dcc()
    result = []
    for name in arguments:
        document = etree.parse(name, parser)
        count, found = findings(schematron, document)
        units = {unit for element in document.iter(f"{SI}unit", f"{SI}unitXMLList") for unit in element.text.split()}
        read = pydcc.DCC(name, signature_verification=False)  # xmlsec1 verifies signatures
        result.append({
            "schema": schema_errors(schema, document),
            "rules": count,
            "findings": found,
            "invalid_units": sorted(unit for unit in units if not dsi_unit.DsiUnit(unit).valid),
            "number": read.uid(),
            "day": read.calibration_date().date().isoformat(),
            "laboratory": read.calibration_laboratory_name(),
            "language": read.mandatory_language(),
            "previous": read.has_previous_report(),
            "results": [quantity(name, value) for name, value in read.get_calibration_results("name", "en")],
        })
    print(json.dumps(result))


main(sys.argv[1:])
