import { render } from "preact";
import "ol/ol.css";
import "./styles/colours.css";
import "./styles/theme.css";
import "./styles/frame.css";
import "./styles/alarms.css";
import "./styles/people.css";
import "./styles/commands.css";
import "./styles/plan.css";
import "./styles/dialogs.css";
import "./styles/small.css";
import "./styles/red-light.css";
import "./appearance";
import { resume } from "./sessions";
import { App } from "./ui/App";

await resume();
const root = document.getElementById("app");
if (root) render(<App />, root);
