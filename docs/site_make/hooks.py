# SPDX-License-Identifier: BSD-3-Clause
"""Hooks of MkDocs: bring the Markdown files of the repository and the API reference of Doxygen
into one site. docs/site runs Doxygen before."""

import fnmatch
import json
import posixpath
import re
import subprocess
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from mkdocs.plugins import event_priority
from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
API = ROOT / "build/site_work/api"  # the pages of Doxygen
PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs/**/*.md",
         "scenes/**/*.md", "bench/**/*.md"]
ASSETS = {".svg", ".png", ".webp", ".jpg"}
# How a file is shown that is neither a page, nor a picture, nor a header of the reference.
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".py": "python", ".sh": "sh", ".yaml": "yaml",
             ".yml": "yaml", ".awk": "awk", ".json": "json", ".cmake": "cmake"}
FENCE = re.compile(r"^( *)(```|~~~)")
LINK = re.compile(r"(\]\()([^()\s]+)(\))")

SKIPPED = r"<pre.*?</pre>|<a .*?</a>|<h\d.*?</h\d>"  # of a page, where no names become links

names = {}  # what inline code may name, and its place in the reference
sources = {}  # path of a header in the repository: its page of the reference
shown = {}  # other files that pages link to, by their path: the page that shows the file


def listed():
    """The files of the repository, also those not committed yet."""
    out = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, text=True,
                         capture_output=True, check=True).stdout
    return [path for path in out.splitlines() if (ROOT / path).is_file()]


def fits(path, pattern):
    """As the shell's globs: a star does not match a slash, but two stars match any folders."""
    if "**/" in pattern:
        head, tail = pattern.split("**/")
        return path.startswith(head) and fnmatch.fnmatchcase(posixpath.basename(path), tail)
    return posixpath.dirname(path) == posixpath.dirname(pattern) and fnmatch.fnmatchcase(
        path, pattern)


def on_config(config):
    pages = sorted(p for p in listed() if any(fits(p, pattern) for pattern in PAGES))
    config.extra["pages"] = pages
    named = set(leaves(config.nav))
    config.nav = [entry for entry in expanded(config.nav, pages, named)]
    sources.update((path, f"api/{file.get('id')}_source.html") for path, file in headers())
    names.update(named_places())
    return config


def leaves(nav):
    for entry in nav:
        for value in entry.values() if isinstance(entry, dict) else [entry]:
            yield from leaves(value) if isinstance(value, list) else [value]


def expanded(nav, pages, named):
    """The navigation with the pages that each pattern fits. `PAGE?` is a page that may be missing.
    """
    for entry in nav:
        if isinstance(entry, dict):
            ((title, value),) = entry.items()
            if isinstance(value, list):
                value = list(expanded(value, pages, named))
            yield {title: value}
        elif entry.endswith("?"):
            named.add(entry[:-1])
            if entry[:-1] in pages:
                yield entry[:-1]
        elif "*" in entry:
            found = [page for page in pages if page not in named and fits(page, entry)]
            named.update(found)
            yield from found
        else:
            yield entry


def on_files(files, config):
    for page in config.extra["pages"]:
        files.append(File.generated(config, page, abs_src_path=str(ROOT / page)))
        for target in targets_of(page):
            bring(target, files, config)
    files.append(File.generated(config, "reference.md", content=reference()))
    for path in sorted(API.iterdir()):
        if path.suffix == ".html":
            files.append(File.generated(config, f"api/{path.name}", content=mended(path)))
        else:
            files.append(File.generated(config, f"api/{path.name}", abs_src_path=str(path)))
    return files


def mended(path):
    """A page of Doxygen without the links to what it has left out: its summaries name sections of
    private classes, and its lists of names link concepts, which have no pages."""
    text = path.read_text(encoding="utf-8")
    text = re.sub(r'<a href="#([^"]+)">[^<]*</a> &#124;\n',
                  lambda link: link[0] if f'name="{link[1]}"' in text else "", text)
    return re.sub(r'<a class="el" href="concept[^"]*"[^>]*>([^<]*)</a>', r"\1", text)


def targets_of(page):
    """The files that a page links to, by their path in the repository."""
    for line in prose((ROOT / page).read_text()):
        for _, target, _ in LINK.findall(line):
            path = target.split("#")[0]
            if path and ":" not in path:
                yield posixpath.normpath(posixpath.join(posixpath.dirname(page), path))


def prose(text):
    """The lines of a page outside of fences; those inside are empty."""
    fence = ""
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if mark and (not fence or mark[2] == fence):
            fence = "" if fence else mark[2]
            yield ""
        else:
            yield "" if fence else line


def bring(target, files, config):
    """Puts a linked file on the site, as it is or shown on a page of its own."""
    if target.endswith(".md") or target in sources or target in shown:
        return
    if Path(target).suffix in ASSETS:
        if not files.get_file_from_path(target):
            files.append(File.generated(config, target, abs_src_path=str(ROOT / target)))
        return
    visible = re.sub(r"(^|/)[.]", r"\1", target)  # MkDocs leaves out what begins with a dot
    shown[target] = f"files/{visible}.md"
    files.append(File.generated(config, shown[target], content=page_of(target)))


def page_of(target):
    """A page that shows a file or lists a folder. It is not found by the search."""
    head = f"---\ntitle: {target}\nsearch: {{exclude: true}}\n---\n\n# {target}\n\n"
    path = ROOT / target
    if path.is_dir():
        names = sorted(p.removeprefix(target + "/") for p in listed() if p.startswith(target + "/"))
        return head + "".join(f"- `{name}`\n" for name in names)
    text = path.read_text()
    if path.suffix == ".ipynb":
        return head + notebook(json.loads(text))
    language = LANGUAGES.get(path.suffix)
    if not language:
        shebang = text.split("\n")[0]
        language = "sh" if shebang.endswith("sh") else "python" if "python" in shebang else "text"
    return f"{head}~~~~{language}\n{text}~~~~\n"


def notebook(book):
    parts = []
    for cell in book["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(re.sub(r"(?m)^# ", "## ", text))
        else:
            parts.append(f"~~~~python\n{text}\n~~~~")
    return "\n\n".join(parts) + "\n"


def on_page_markdown(markdown, page, config, files):
    here = page.file.src_uri
    # A title is looked for at the beginning only.
    markdown = re.sub(r"\A\s*<!--.*?-->\s*", "", markdown, flags=re.DOTALL)
    lines = markdown.split("\n")
    titles = 0
    for number, line in enumerate(prose(markdown)):
        titles += line.startswith("# ")
        # A page has one title: what stands below another one is a level lower.
        if titles > 1 and re.match(r"#{1,5} ", line):
            line = lines[number] = "#" + line
        if "](" in line:
            lines[number] = LINK.sub(lambda link: link[1] + redirected(link[2], here) + link[3],
                                     line)
    text = "\n".join(lines)
    return front(text) if here == "README.md" else text


def redirected(target, here):
    """The target of a link on the site: as it is, or the page that shows the file."""
    path = target.split("#")[0]
    if not path or ":" in path:
        return target
    full = posixpath.normpath(posixpath.join(posixpath.dirname(here), path))
    page = sources.get(full) or shown.get(full)
    return posixpath.relpath(page, posixpath.dirname(here) or ".") if page else target


def on_page_content(html, page, config, files):
    """Inline code that names a class, a member or a header leads to the reference."""
    if page.file.src_uri.startswith("files/"):
        return html
    here = posixpath.dirname(page.file.dest_uri) or "."

    def linked(match):
        place = names.get(match[1])
        return (f'<a class="api" href="{posixpath.relpath(place, here)}">{match[0]}</a>'
                if place else match[0])

    return re.sub(rf"(?s:{SKIPPED})|<code>([\w:/.]+?)(?:\(\))?</code>", linked, html)


def named_places():
    """The places of headers, and of classes and their members that only one class can be meant by.
    """
    places = {}
    for path, file in headers():
        for name in (path, re.sub(r"^.*?(?=repel/)", "", path)):
            places.setdefault(name, set()).add(f"api/{file.get('id')}.html")
    for compound in compounds():
        name = plain(compound.find("compoundname"))
        if compound.get("kind") not in {"class", "struct"} or compound.get("prot") == "private":
            continue
        short = "::".join(part for part in name.split("::") if part[0].isupper())
        places.setdefault(short, set()).add(f"api/{compound.get('id')}.html")
        for entry in members(compound, short):
            places.setdefault(entry["title"], set()).add(entry["location"])
    return ((name, *place) for name, place in places.items() if len(place) == 1)


def front(text):
    """README.md as the first page: below its first paragraph the way on, and its first picture."""
    picture = re.search(r"(?m)^!\[.*\n", text)
    text = text.replace(picture[0], "", 1)
    first = re.search(r"(?ms)^# .*?\n\n.*?\n\n", text).end()
    buttons = ("[In your program](docs/in_your_program.md){ .md-button .md-button--primary }\n"
               "[Scenes](scenes/README.md){ .md-button }\n"
               "[API reference](reference.md){ .md-button }\n\n")
    return text[:first] + buttons + picture[0] + "\n" + text[first:]


def compounds():
    """The classes, namespaces and files of the reference, as Doxygen describes them in XML."""
    folder = ROOT / "build/site_work/xml"
    index = ElementTree.parse(folder / "index.xml").getroot()
    for entry in index.findall("compound"):
        if entry.get("kind") in {"class", "struct", "namespace", "file"}:
            yield ElementTree.parse(folder / f"{entry.get('refid')}.xml").getroot().find(
                "compounddef")


def headers():
    """Every header of the reference, by its path in the repository."""
    for file in compounds():
        path = file.find("location").get("file")
        if file.get("kind") == "file" and path.endswith(".hpp"):
            yield path.removeprefix(f"{ROOT}/"), file


def plain(element):
    text = "".join(element.itertext()) if element is not None else ""
    return " ".join(text.split())


def reference():
    """The page that leads into the reference: every header with what its comment says."""
    rooms = {}
    for path, file in headers():
        said = plain(file.find("briefdescription")) or plain(file.find("detaileddescription"))
        sentence = re.split(r"(?<=[.;:]) ", said)[0] if said else ""
        rooms.setdefault(posixpath.dirname(path), []).append((path, file.get("id"), sentence))
    text = ["# API reference\n",
            "The search on this site finds classes and functions too. Begin with "
            "[In your program](docs/in_your_program.md); [the map](docs/architecture.md) says what "
            "each folder holds.\n",
            "[Classes](api/annotated.html){ .md-button } [Namespaces](api/namespaces.html)"
            "{ .md-button } [All names](api/functions.html){ .md-button }\n"]
    order = sorted(rooms, key=lambda room: (not room.startswith("core"), room))
    for room in order:
        text.append(f"## {room}\n\n| header | what it holds |\n|---|---|")
        for path, identity, sentence in sorted(rooms[room]):
            name = posixpath.basename(path)
            sentence = sentence.replace("|", "\\|").replace("<", "&lt;")
            text.append(f"| [{name}](api/{identity}.html) | {sentence} |")
        text.append("")
    return "\n".join(text)


@event_priority(-50)  # after the plugin that writes the index, before the one that copies it
def on_post_build(config):
    """Adds the classes and functions of the reference to what the search finds."""
    # Only a server can show it, and only at its top.
    (Path(config.site_dir) / "404.html").unlink()
    path = Path(config.site_dir) / "search/search_index.json"
    index = json.loads(path.read_text())
    for compound in compounds():
        if compound.get("kind") == "file" or compound.get("prot") == "private":
            continue
        name = plain(compound.find("compoundname"))
        if compound.get("kind") != "namespace":
            index["docs"].append({"location": f"api/{compound.get('id')}.html", "title": name,
                                  "text": said_of(compound)})
        index["docs"] += members(compound, name)
    path.write_text(json.dumps(index, sort_keys=True, separators=(",", ":")))


def said_of(element):
    return (plain(element.find("briefdescription")) + " " +
            plain(element.find("detaileddescription"))).strip()


def members(compound, of):
    """An entry for each name; overloads share one."""
    entries = {}
    for member in compound.iter("memberdef"):
        if member.get("prot") == "private":
            continue
        page, _, anchor = member.get("id").rpartition("_1")
        title = f"{of}::{plain(member.find('name'))}"
        entry = entries.setdefault(title, {"location": f"api/{page}.html#{anchor}", "title": title,
                                           "text": "", "boost": 0.7})
        entry["text"] = (entry["text"] + " " + said_of(member)).strip()
    return entries.values()
