"""What the site does to a page besides what mkdocs does: order, maths, pictures. A page that cannot be shown stops the build."""

import html
import json
import os
import re
import subprocess

from mkdocs.exceptions import PluginError
from mkdocs.utils import get_relative_url

API = "/api/index.html"  # not a page of mkdocs, so it would leave the link as it is
LISTED = re.compile(r"^\d+\. \[([^\]]+)\]\(([^)#]+)\)", re.M)
FENCE = re.compile(r"^```(math|mermaid)\n(.*?)^```$", re.M | re.S)
FORMULA = re.compile(r'<(span|div) class="arithmatex">\\([(\[])(.*?)\\[)\]]</\1>', re.S)

NODE = re.compile(r'^(\w+)(?:\["(.*)"\]|\[\("(.*)"\)\])$')
EDGE = re.compile(r'^(\w+) (?:(--|-\.) (?:"(.*)"|(\S+)) )?(-->|\.->) (\w+)$')


def on_config(config):
    """The pages in the order in which docs/README.md lists them; none may be missing there."""
    folder = config["docs_dir"]
    with open(os.path.join(folder, "docs/README.md"), encoding="utf-8") as file:
        listed = LISTED.findall(file.read())
    missing = {name for name in os.listdir(os.path.join(folder, "docs")) if name.endswith(".md")}
    missing -= {target for _, target in listed} | {"README.md"}
    if missing:
        raise PluginError(f"docs/README.md does not list {', '.join(sorted(missing))}")
    config["nav"] = [{"Start": "README.md"}, {"Overview": "docs/README.md"}]
    config["nav"] += [{title: f"docs/{target}"} for title, target in listed]
    reference = [{"Channels and types": "lcmtypes/README.md"}, {"Sample log": "logs/README.md"}]
    reference += [{"Examples": "examples/README.md"}, {"Mutation tests": "tests/mutation/README.md"}]
    if config["extra"].get("api"):
        reference.append({"API of the libraries": API})
    config["nav"] += [{"Reference": reference}]
    config["nav"] += [{"Contributing": "CONTRIBUTING.md"}, {"Changes": "CHANGELOG.md"}, {"Licences": "THIRD_PARTY_LICENSES.md"}]
    return config


def quoted(text):
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("<br/>", "\\n") + '"'


def mermaid_to_dot(text):
    """The part of mermaid's flow charts that our pages use: nodes, arrows, dashed arrows, labels. Git forges draw it themselves."""
    lines = [line.strip() for line in text.strip().splitlines()]
    direction = re.match(r"^flowchart (TD|TB|LR)$", lines[0])
    if not direction:
        raise PluginError(f"not a flow chart: {lines[0]}")
    dot = ["digraph {", f"rankdir={'LR' if direction[1] == 'LR' else 'TB'}; bgcolor=transparent;"]
    dot += ['node [shape=box, style="rounded,filled", fillcolor="#e8eaf6", fontname=sans, fontsize=12];']
    dot += ["edge [fontname=sans, fontsize=10];"]
    for line in filter(None, lines[1:]):
        node, edge = NODE.match(line), EDGE.match(line)
        if node:
            shape = ", shape=cylinder, style=filled" if node[3] else ""
            dot.append(f"{node[1]} [label={quoted(node[2] or node[3])}{shape}];")
        elif edge and (edge[2] == "-.") == (edge[5] == ".->"):
            style = ", style=dashed, constraint=false" if edge[2] == "-." else ""
            dot.append(f"{edge[1]} -> {edge[6]} [label={quoted(edge[3] or edge[4] or '')}{style}];")
        else:
            raise PluginError(f"this line of a flow chart is not understood: {line}")
    return "\n".join(dot + ["}"])


def draw(text):
    dot = mermaid_to_dot(text)
    svg = subprocess.run(["dot", "-Tsvg"], input=dot, capture_output=True, text=True, check=True).stdout
    svg = svg[svg.index("<svg") :].replace("\n", " ")
    return f'<div class="diagram">{svg}</div>'


def on_page_markdown(markdown, page, **_):
    def replace(match):
        return draw(match[2]) if match[1] == "mermaid" else f"$$\n{match[2]}$$"

    try:
        return FENCE.sub(replace, markdown)
    except PluginError as error:
        raise PluginError(f"{page.file.src_path}: {error}") from error


def on_page_content(content, page, **_):
    """Sets the formulas, all of a page in one process."""
    formulas = [{"display": match[2] == "[", "tex": html.unescape(match[3])} for match in FORMULA.finditer(content)]
    if not formulas:
        return content
    program = os.path.join(os.path.dirname(__file__), "render_math.js")
    done = subprocess.run(["node", program], input=json.dumps(formulas), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise PluginError(f"{page.file.src_path}: {done.stderr.strip()}")
    rendered = iter(json.loads(done.stdout))
    return FORMULA.sub(lambda match: f'<{match[1]} class="formula">{next(rendered)}</{match[1]}>', content)


def on_post_page(output, page, **_):
    return output.replace(f'href="{API}"', f'href="{get_relative_url(API, page.url)}"')
