#nullable enable
using System;
using System.Collections.Generic;
using System.Linq;
using HaptoFlow.Preview;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Records strokes that the user draws on the patch. Main thread.</summary>
    internal sealed class PatchInput
    {
        private static readonly int ControlHint = "HaptoFlow.TexturePreview.Patch".GetHashCode();

        private readonly TexturePreviewState state;
        private readonly DrawnStroke drawn = new DrawnStroke();

        public PatchInput(TexturePreviewState state) => this.state = state;

        public event Action? Ended;

        /// <summary>Handles an event. With Shift, a touch is added to the stroke; otherwise a new stroke starts. A
        /// mouse presses with the force that is set, a pen at half its maximum pressure.</summary>
        /// <param name="patch">Place of the patch on the screen.</param>
        /// <param name="clockSeconds">Time of the event.</param>
        public void Handle(Event input, Rect patch, double clockSeconds)
        {
            int control = GUIUtility.GetControlID(ControlHint, FocusType.Passive, patch);
            switch (input.GetTypeForControl(control))
            {
                case EventType.MouseDown when input.button == 0 && patch.Contains(input.mousePosition):
                    GUIUtility.hotControl = control;
                    GUIUtility.keyboardControl = 0;
                    Begin(input, patch, clockSeconds);
                    input.Use();
                    break;
                case EventType.MouseDrag when GUIUtility.hotControl == control:
                    Move(input, patch, clockSeconds);
                    input.Use();
                    break;
                case EventType.MouseUp when GUIUtility.hotControl == control:
                    Move(input, patch, clockSeconds);
                    GUIUtility.hotControl = 0;
                    input.Use();
                    Ended?.Invoke();
                    break;
            }
        }

        private void Begin(Event input, Rect patch, double clockSeconds)
        {
            (double x, double y) = Place(input, patch);
            bool adds = input.shift && state.Preset == StrokePreset.Drawn;
            IEnumerable<DrawnPoint> before = adds ? state.Drawn : Array.Empty<DrawnPoint>();
            drawn.Begin(clockSeconds, x, y, Force(input), before);
            Keep();
        }

        private void Move(Event input, Rect patch, double clockSeconds)
        {
            (double x, double y) = Place(input, patch);
            drawn.Move(clockSeconds, x, y, Force(input));
            Keep();
        }

        private void Keep()
        {
            DrawnPoint[] points = drawn.Points.ToArray();
            state.Change("Stroke", changed =>
            {
                changed.Drawn = points;
                changed.Preset = StrokePreset.Drawn;
            });
        }

        private double Force(Event input) =>
            input.pointerType == PointerType.Pen ? 2.0 * input.pressure * state.ForceNewtons : state.ForceNewtons;

        private static (double X, double Y) Place(Event input, Rect patch) => PatchPicture.ToMetres(
            new Box(patch.x, patch.y, patch.width, patch.height), input.mousePosition.x, input.mousePosition.y);
    }
}
