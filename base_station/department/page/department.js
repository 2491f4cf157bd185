// The page of a department: asks once a second, and shows what it is told.

const PERIOD_MS = 1000;
const PAGE = 100;
const by = (id) => document.getElementById(id);
const state = { skip: 0, total: 0, timer: 0 };

async function ask(path, body) {
  const options = body === undefined ? {} : {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(body),
  };
  const response = await fetch(`/api/v1${path}`, options);
  const answer = response.status === 204 ? null : await response.json();
  if (!response.ok) throw Object.assign(new Error(answer.detail), { status: response.status });
  return answer;
}

function cell(content, className = "") {
  const made = document.createElement("td");
  made.append(...[content].flat());
  made.className = className;
  return made;
}

function rows(id, cells, empty) {
  const body = by(id);
  const made = cells.map((ones) => {
    const row = document.createElement("tr");
    row.append(...ones);
    return row;
  });
  if (made.length === 0) {
    const row = document.createElement("tr");
    const only = cell(empty, "note");
    only.colSpan = 8;
    row.append(only);
    made.push(row);
  }
  body.replaceChildren(...made);
}

function link(text, url) {
  if (!url) return text;
  const made = document.createElement("a");
  Object.assign(made, { href: url, textContent: text, target: "_blank", rel: "noopener" });
  return made;
}

function age(seconds) {
  if (seconds < 90) return `${Math.max(0, Math.round(seconds))} s`;
  if (seconds < 5400) return `${Math.round(seconds / 60)} min`;
  return `${Math.round(seconds / 3600)} h`;
}

const since = (now, then) => age((now - then) / 1000);
const time = (ms) => new Date(ms).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" });
const count = (number) => cell(String(number), number > 0 ? "bad" : "");

function showOverview(view) {
  const consoles = new Map(view.stations.map((one) => [one.station, one.console_url]));
  const open = view.incidents.filter((one) => one.closed_ms === null);
  by("totals").textContent =
    `${open.length} open incidents, ${view.open_alarms} alarms, ${view.people} people, ` +
    `${view.stations.length} stations`;
  by("problems").replaceChildren(...view.problems.map((text) => {
    const item = document.createElement("li");
    item.textContent = text;
    return item;
  }));
  rows("alarms", view.alarms.map((one) => [
    cell(since(view.now_ms, one.raised_ms)),
    cell(link(one.station, consoles.get(one.station))),
    cell(one.person || one.unit_id),
    cell(one.text, one.priority === 1 ? "bad" : "doubt"),
    cell(one.state + (one.by ? ` by ${one.by}` : "")),
  ]), "No open alarms.");
  rows("incidents", view.incidents.slice(0, 50).map((one) => [
    cell(link(one.name, consoles.get(one.station)), one.closed_ms === null ? "" : "note"),
    cell(one.station),
    cell(String(one.people)),
    count(one.maydays),
    count(one.alarms),
    count(one.overdue),
    cell(time(one.opened_ms) + (one.closed_ms === null ? "" : `, closed ${time(one.closed_ms)}`)),
  ]), "No incidents.");
  const stateText = {
    live: () => ["live", "good"],
    away: (one) => [`away for ${since(view.now_ms, one.last_ms)}: people are shown as last reported`, "bad"],
    never: () => ["has never reported", "doubt"],
  };
  rows("stations", view.stations.map((one) => [
    cell(link(one.station, one.console_url)),
    cell(...stateText[one.state](one)),
    cell(`${one.people}, ${one.in_incident} in an incident`),
    cell(String(one.waiting)),
    cell(one.problems.join("; "), "note"),
  ]), "No stations are enrolled: muster pki enroll NAME --department-station");
  const chosen = by("station").value;
  const names = ["", ...view.stations.map((one) => one.station)];
  if (by("station").options.length !== names.length) {
    by("station").replaceChildren(...names.map((name) => new Option(name || "all", name)));
    by("station").value = names.includes(chosen) ? chosen : "";
  }
}

function place(one) {
  if (one.position_age_s === null) return "not located";
  const floor = one.floor === null ? "" : `floor ${one.floor}, `;
  const where = one.lat_deg === null
    ? `${one.north_m.toFixed(0)} m N ${one.east_m.toFixed(0)} m E`
    : `${one.lat_deg.toFixed(5)}, ${one.lon_deg.toFixed(5)}`;
  return `${floor}${where}, ± ${one.radius_m.toFixed(0)} m, ${age(one.position_age_s)} ago`;
}

function showPeople(view) {
  state.total = view.total;
  const last = Math.min(state.skip + PAGE, view.total);
  by("shown").textContent = view.total ? `${state.skip + 1} to ${last} of ${view.total}` : "nobody";
  by("before").disabled = state.skip === 0;
  by("after").disabled = last >= view.total;
  const links = { live: "good", stale: "doubt", never: "doubt" };
  rows("people", view.people.map((one) => [
    cell([one.name || one.label || one.unit_id, one.mayday ? " MAYDAY" : ""], one.mayday ? "bad" : ""),
    cell(one.crew),
    cell(one.station),
    cell(one.link.replace("_", " "), links[one.link] ?? "bad"),
    cell(place(one)),
    cell(one.par_overdue ? "overdue" : one.par.replace("_", " "), one.par_overdue ? "bad" : ""),
    count(one.alarms),
  ]), "Nobody.");
}

async function refresh() {
  clearTimeout(state.timer);
  const query = new URLSearchParams({
    search: by("search").value, station: by("station").value, skip: state.skip, limit: PAGE,
  });
  try {
    const [overview, people] = await Promise.all([ask("/department"), ask(`/department/people?${query}`)]);
    showOverview(overview);
    showPeople(people);
    showLogin(false);
  } catch (error) {
    if (error.status === 401 || error.status === 403) {
      showLogin(true, error.status === 403 ? error.message : "");
      return;
    }
    by("totals").textContent = `The department does not answer; what is shown is old. ${error.message}`;
  }
  state.timer = setTimeout(refresh, PERIOD_MS);
}

function showLogin(wanted, problem = "") {
  by("login").hidden = !wanted;
  by("picture").hidden = by("log-out").hidden = wanted;
  by("login-problem").textContent = problem;
  if (wanted) by("totals").textContent = "";
}

by("login").addEventListener("submit", async (event) => {
  event.preventDefault();
  const form = new FormData(event.target);
  try {
    const me = await ask("/login", { username: form.get("username"), password: form.get("password") });
    if (me.must_change_password && form.get("new_password")) {
      await ask("/me/password", { old_password: form.get("password"), new_password: form.get("new_password") });
    } else if (me.must_change_password) {
      by("new-password").hidden = false;
      by("login-problem").textContent = "This password was generated: choose a new one.";
      return;
    }
    event.target.reset();
    by("new-password").hidden = true;
    refresh();
  } catch (error) {
    by("login-problem").textContent = error.message;
  }
});

by("log-out").addEventListener("click", async () => {
  clearTimeout(state.timer);
  await ask("/logout", {});
  showLogin(true);
});

for (const id of ["search", "station"]) {
  by(id).addEventListener("input", () => { state.skip = 0; refresh(); });
}
by("before").addEventListener("click", () => { state.skip = Math.max(0, state.skip - PAGE); refresh(); });
by("after").addEventListener("click", () => { state.skip += PAGE; refresh(); });

refresh();
