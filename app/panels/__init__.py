"""Everything around the 3-D view: composition only; each part knows the `State` and the `Actions`.

Right: the skill and the tabs Teach, Try, Move, Fix, Compare. Left: the lesson, the saved skills
and the slice at the playhead. Floating at the bottom: the timeline.
"""

from collections.abc import Sequence
from typing import Final, Protocol

import viser

from app.actions import Actions
from app.panels.compare import ComparePanel
from app.panels.deleted import DeletedPanel
from app.panels.demonstrations import DemonstrationsPanel
from app.panels.encoding import EncodingPanel
from app.panels.export import ExportPanel
from app.panels.hand import HandPanel
from app.panels.header import HeaderPanel
from app.panels.keys import Keys
from app.panels.kinds import KindsPanel
from app.panels.landmarks import LandmarksPanel
from app.panels.lesson import LessonPanel
from app.panels.line import LinePanel
from app.panels.offer import OfferPanel
from app.panels.physics import PhysicsPanel
from app.panels.placing import PlacingPanel
from app.panels.proposal import ProposalPanel
from app.panels.replay import ReplayPanel
from app.panels.reposition import RepositionPanel
from app.panels.rules import RulesPanel
from app.panels.skills import SkillsPanel
from app.panels.slice import SlicePanel
from app.panels.smoothing import SmoothingPanel
from app.panels.starts import StartsPanel
from app.panels.status import StatusPanel
from app.panels.suggestion import SuggestionPanel
from app.panels.things import ThingsPanel
from app.panels.timeline import TimelinePanel
from app.panels.tool import ToolPanel
from app.panels.tries import TriesPanel
from app.panels.verdict import VerdictPanel
from app.panels.versions import VersionsPanel
from app.store import State

MAIN_WIDTH: Final = 320
SIDE_WIDTH: Final = 270
TIMELINE_WIDTH: Final = 440
GAP: Final = 14
"""Between the timeline and the edges of the 3-D view [px]."""


class Panel(Protocol):
    """One part of the page."""

    def draw(self, state: State) -> None:
        """Show the state, sending only what differs."""
        ...


class Panels:
    """All panels of one tab of the browser.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client, so that nobody else sees or uses them.
    actions : Actions
        Where everything that a person does is posted.
    skills : sequence of (name, title)
        Built-in skills to choose from.
    """

    def __init__(self, gui: viser.GuiApi, actions: Actions, skills: Sequence[tuple[str, str]]) -> None:
        self._parts: tuple[Panel, ...] = (
            Keys(gui, actions),
            *_main(gui, actions, skills),
            *_side(gui, actions),
            _timeline(gui, actions),
        )

    def draw(self, state: State) -> None:
        """Show a state; what it shows already costs a comparison and sends nothing."""
        for part in self._parts:
            part.draw(state)


def _main(gui: viser.GuiApi, actions: Actions, skills: Sequence[tuple[str, str]]) -> tuple[Panel, ...]:
    gui.set_panel_label("gc-teach")
    gui.main_panel.dock_right()
    gui.main_panel.set_width(MAIN_WIDTH)
    header: tuple[Panel, ...] = (
        HeaderPanel(gui, actions, skills),
        ExportPanel(gui, actions),
        StatusPanel(gui),
        ProposalPanel(gui, actions),
        RepositionPanel(gui, actions),
    )
    tabs = gui.add_tab_group()
    with tabs.add_tab("Teach", viser.Icon.HAND_GRAB):
        teach: tuple[Panel, ...] = (
            SuggestionPanel(gui, actions),
            DemonstrationsPanel(gui, actions),
            OfferPanel(gui, actions),
            HandPanel(gui, actions),
            ToolPanel(gui, actions),
            KindsPanel(gui, actions),
            EncodingPanel(gui, actions),
        )
    with tabs.add_tab("Try", viser.Icon.PLAYER_PLAY):
        tries: tuple[Panel, ...] = (
            StartsPanel(gui, actions),
            VerdictPanel(gui, actions),
            PhysicsPanel(gui, actions),
        )
    with tabs.add_tab("Move", viser.Icon.MAP_PIN):
        move: tuple[Panel, ...] = (
            LandmarksPanel(gui, actions),
            TriesPanel(gui, actions),
            PlacingPanel(gui, actions),
            SmoothingPanel(gui, actions),
            ThingsPanel(gui, actions),
        )
    with tabs.add_tab("Fix", viser.Icon.TOOL):
        fix: tuple[Panel, ...] = (
            ReplayPanel(gui, actions),
            LinePanel(gui, actions),
            RulesPanel(gui, actions),
        )
    with tabs.add_tab("Compare", viser.Icon.CHART_BAR):
        compare = ComparePanel(gui, actions)
    return (*header, *teach, *tries, *move, *fix, compare)


def _side(gui: viser.GuiApi, actions: Actions) -> tuple[Panel, ...]:
    upper, lower = gui.add_panel(), gui.add_panel()
    with upper.add_tab("Lesson", viser.Icon.SCHOOL):
        lesson = LessonPanel(gui, actions)
    with upper.add_tab("My skills", viser.Icon.FOLDER):
        mine: tuple[Panel, ...] = (
            SkillsPanel(gui, actions),
            DeletedPanel(gui, actions),
            VersionsPanel(gui, actions),
        )
    with lower.add_tab("Slice (cross-section)", viser.Icon.CIRCLE_DASHED):
        section = SlicePanel(gui)
    upper.dock_left()
    upper.set_width(SIDE_WIDTH)
    lower.dock_below(upper)
    return (lesson, *mine, section)


def _timeline(gui: viser.GuiApi, actions: Actions) -> Panel:
    panel = gui.add_panel()
    with panel.add_tab("Timeline", viser.Icon.CLOCK_PLAY):
        timeline = TimelinePanel(gui, actions)
    panel.float(x=GAP, y=-GAP, width=TIMELINE_WIDTH)
    return timeline
