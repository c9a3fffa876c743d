"""Runs SPARQL 1.1 queries on a file of N-Triples with rdflib, within limits.

usage: run_sparql.py GRAPH.nt OUT csv|json SECONDS MEGABYTES QUERY.rq...

Writes OUT.0, OUT.1, ...: the solutions of SELECT, `boolean` of ASK, the triples of CONSTRUCT, with
blank nodes as the graph labels them. The last line on standard error says what was done last, in
fields that tabs divide: "query NUMBER", or "error KIND NUMBER LINE COLUMN TEXT". Where a query, or
reading the graph, takes longer than SECONDS the process ends by SIGALRM.

A query reads nothing but the graph: SERVICE, FROM and updates are refused, and once queries run no
file is opened but for the results, no process started and no connection made.
"""
import resource
import signal
import sys

GRAPH, OUT, FORMAT = sys.argv[1:4]
SECONDS, MEGABYTES = float(sys.argv[4]), int(sys.argv[5])
number = 0  # of the query at work


def start_clock():
    signal.setitimer(signal.ITIMER_REAL, SECONDS)


# The kernel ends us, whatever the interpreter is busy with.
signal.signal(signal.SIGALRM, signal.SIG_DFL)
signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGALRM})
start_clock()
resource.setrlimit(resource.RLIMIT_AS, (MEGABYTES << 20, MEGABYTES << 20))


def say(*fields):
    sys.stderr.write("\t".join(" ".join(str(f).split()) for f in fields) + "\n")
    sys.stderr.flush()


def fail(kind, text, line=0, column=0):
    say("error", kind, number, line, column, text)
    sys.exit(3)


try:
    import csv
    import json
    import logging

    import rdflib
    from rdflib.plugins import sparql
    from rdflib.plugins.parsers.ntriples import NTGraphSink, W3CNTriplesParser
    from rdflib.plugins.sparql.algebra import translateQuery
    from rdflib.plugins.sparql.evaluate import evalQuery
    from rdflib.plugins.sparql.parser import parseQuery, parseUpdate
    from rdflib.plugins.sparql.parserutils import CompValue
except ImportError as error:
    fail("absent", error)

logging.disable(logging.CRITICAL)
rdflib.NORMALIZE_LITERALS = False  # numbers are shown as the graph writes them
sparql.SPARQL_LOAD_GRAPHS = False


class GivenLabels(dict):
    """Blank nodes under the labels of the file."""

    def get(self, label, default=None):
        return rdflib.BNode(label)


def read_graph(name):
    graph = rdflib.Graph()
    with open(name, "rb") as file:
        W3CNTriplesParser(NTGraphSink(graph), bnode_context=GivenLabels()).parse(file)
    return graph


def parsed(text):
    try:
        return parseQuery(text)
    except RecursionError:
        raise
    except Exception as error:
        if not hasattr(error, "lineno"):
            fail("query", error)
        try:
            parseUpdate(text)
        except Exception:
            fail("syntax", error.line.strip()[:80] or "its end", error.lineno, error.column)
        fail("refused", "an update, which would change the graph")


def refuse_foreign(node):
    """Walks the parse tree: a query asks the graph that it is given."""
    if isinstance(node, CompValue):
        if node.name == "ServiceGraphPattern":
            fail("refused", "SERVICE, which would ask another computer")
        if node.name == "DatasetClause":
            fail("refused", "FROM, which would read another graph")
        if node.name == "DescribeQuery":
            fail("refused", "DESCRIBE, whose answer each engine chooses for itself")
    if isinstance(node, dict):
        node = node.values()
    elif not isinstance(node, (list, tuple)) and not hasattr(node, "asList"):  # of pyparsing
        return
    for child in node:
        refuse_foreign(child)


def forbid_outside(event, arguments):
    if event in ("open", "os.system", "os.exec", "os.posix_spawn", "os.fork", "os.remove",
                 "os.rename", "subprocess.Popen", "socket.__new__", "socket.connect",
                 "socket.getaddrinfo", "urllib.Request", "ctypes.dlopen"):
        raise PermissionError("a query must not use " + event)


def text_of(term):
    if term is None:
        return ""
    return "_:" + str(term) if isinstance(term, rdflib.BNode) else str(term)


def json_of(term):
    if isinstance(term, rdflib.BNode):
        return {"type": "bnode", "value": str(term)}
    if isinstance(term, rdflib.URIRef):
        return {"type": "uri", "value": str(term)}
    value = {"type": "literal", "value": str(term)}
    if term.language:
        value["xml:lang"] = term.language
    elif term.datatype:
        value["datatype"] = str(term.datatype)
    return value


def table_of(result):
    """Names of columns and rows of terms."""
    if result["type_"] == "SELECT":
        names = [str(v) for v in result["vars_"]]
        return names, [[row.get(rdflib.Variable(n)) for n in names] for row in result["bindings"]]
    return ["subject", "predicate", "object"], list(result["graph"])


def write_csv(result, out):
    writer = csv.writer(out, lineterminator="\n")
    if result["type_"] == "ASK":
        writer.writerows([["boolean"], ["true" if result["askAnswer"] else "false"]])
        return
    names, rows = table_of(result)
    writer.writerow(names)
    for row in rows:
        writer.writerow([text_of(term) for term in row])


def write_json(result, out):
    """SPARQL 1.1 Query Results JSON Format; triples as rows of three columns."""
    if result["type_"] == "ASK":
        document = {"head": {}, "boolean": bool(result["askAnswer"])}
    else:
        names, rows = table_of(result)
        bindings = [{n: json_of(t) for n, t in zip(names, row) if t is not None} for row in rows]
        document = {"head": {"vars": names}, "results": {"bindings": bindings}}
    json.dump(document, out, indent=1, ensure_ascii=False)
    out.write("\n")


def translated(name):
    with open(name, encoding="utf-8") as file:
        tree = parsed(file.read())
    refuse_foreign(tree)
    try:
        return translateQuery(tree)
    except RecursionError:
        raise
    except Exception as error:
        fail("query", error)


def answer(graph, query, out):
    try:
        (write_csv if FORMAT == "csv" else write_json)(evalQuery(graph, query, {}), out)
    except (MemoryError, RecursionError):
        raise
    except Exception as error:
        fail("query", "%s: %s" % (type(error).__name__, error))


def main():
    global number
    graph = read_graph(GRAPH)
    queries, outs = [], []
    for number, name in enumerate(sys.argv[6:]):
        queries.append(translated(name))
        outs.append(open("%s.%d" % (OUT, number), "w", encoding="utf-8", newline=""))
    sys.addaudithook(forbid_outside)
    for number, (query, out) in enumerate(zip(queries, outs)):
        say("query", number)
        start_clock()
        answer(graph, query, out)
        out.close()


try:
    main()
except MemoryError:
    fail("memory", "out of memory")
except RecursionError:
    fail("query", "is nested too deeply")
