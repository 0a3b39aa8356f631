#nullable enable
using System;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace HaptoFlow.Editor
{
    /// <summary>Window > HaptoFlow > Texture Preview: renders, plays and draws the vibration of materials without a
    /// headset. Rendering and analysis run in the background.</summary>
    internal sealed class TexturePreviewWindow : PreviewWindow<TexturePreviewState>
    {
        private static readonly GUIContent FromRecording = new GUIContent("New Material from Recording\u2026",
            "Learns a material from a recording of ten seconds, and saves it as a Haptic Material.");

        private EditorPicture? strokePicture;
        private EditorPicture? chartsPicture;
        private PreviewControls? controls;
        private SliderControls? sliders;
        private PatchInput? patch;

        /// <summary>Null while the window is closed.</summary>
        internal PreviewSession? Session { get; private set; }

        /// <summary>Null while the window is closed.</summary>
        internal PreviewPlayer? Player { get; private set; }

        internal Func<double> ClockSeconds { get; set; } = () => EditorApplication.timeSinceStartup;

        [MenuItem("Window/HaptoFlow/Texture Preview", false, 2100)]
        internal static void Open() => Open<TexturePreviewWindow>(1200f, 940f);

        /// <summary>Opens the window with the material of a surface, with its relief, or of a Haptic Material
        /// asset.</summary>
        internal static void Open(Object described)
        {
            Open();
            if (SceneMaterial.TryRead(described, out LabelMix mix, out HapticMaterial? learnt))
            {
                GetWindow<TexturePreviewWindow>().State.Take(mix, learnt, SelectedMaterial.Of(described));
            }
        }

        protected override PreviewRoom Room =>
            State.ShowsSliders ? PreviewRoom.WithSliders : PreviewRoom.Default;

        protected override bool IsOpen => Session != null;

        protected override void OnEnable()
        {
            base.OnEnable();
            titleContent = new GUIContent("Texture Preview");
            EditorApplication.projectChanged += OnProjectChanged;
        }

        protected override void OnDisable()
        {
            EditorApplication.projectChanged -= OnProjectChanged;
            base.OnDisable();
        }

        protected override void Begin()
        {
            Session = new PreviewSession(State);
            strokePicture = new EditorPicture(DrawStroke);
            chartsPicture = new EditorPicture(DrawCharts);
            controls = new PreviewControls(State);
            sliders = new SliderControls(State);
            Player = new PreviewPlayer(State, Session);
            patch = new PatchInput(State);
            patch.Ended += Player.PlayWhenReady;
        }

        protected override bool TakesKey(Event input) =>
            PreviewKeys.Handle(input, State, Player!.Toggle, () => Later(Export));

        protected override void DrawControls()
        {
            controls!.Draw(Session!.Model);
            if (SceneControls.Draw(State, Session.Model) is { } message)
            {
                ShowNotification(new GUIContent(message));
            }
            Player!.DrawButtons(() => Later(Export));
            sliders!.Draw(ModelInUse(), () => Later(Save));
            if (GUILayout.Button(FromRecording))
            {
                NewMaterialWindow.Open();
            }
        }

        protected override void DrawPictures(PreviewLayout layout)
        {
            ShowStroke(layout.StrokePanel);
            ShowCharts(layout.Charts);
        }

        internal override void Step()
        {
            if (Session == null)
            {
                return;
            }
            Session.Refresh(ModelInUse(), GUIUtility.hotControl != 0);
            bool isOther = Session.Poll();
            if (Player!.Step() || isOther)
            {
                Repaint();
            }
        }

        /// <summary>Blocks until the present settings are rendered.</summary>
        internal void Finish()
        {
            Session!.Refresh(ModelInUse(), false);
            Session.Finish();
            Player!.Step();
            Repaint();
        }

        /// <summary>Writes the active sound to a WAV file or, by the name's ending, to a clip.</summary>
        /// <returns>An error message; null on success.</returns>
        internal string? ExportTo(string path)
        {
            Finish();
            if (Session!.Problem != null)
            {
                return Session.Problem;
            }
            bool isClip = !path.EndsWith(SoundExport.Endings[(int)SoundFormat.Wav], StringComparison.OrdinalIgnoreCase);
            // A clip of what a simulated device plays would be played by a device once more.
            AnalysedSound sound = isClip && State.ShowsDevice ? Session.Shown!.Sounds[0] : Player!.PlayedSound!;
            return SoundExport.Write(path, sound.Sound, Description());
        }

        /// <summary>How the shown sounds were made, for other tools.</summary>
        private string Description()
        {
            string stroke = State.Preset == StrokePreset.Drawn
                ? "a drawn stroke"
                : SummaryRow.Format("{0}, {1:0.###} m/s, {2:0.##} N",
                    ObjectNames.NicifyVariableName(State.Preset.ToString()).ToLowerInvariant(), State.SpeedMps,
                    State.ForceNewtons);
            return SummaryRow.Format("{0}; model {1}, {2}, seed {3}", stroke, ModelInUse()!.name,
                Session!.Shown!.Request.Tier, State.Seed);
        }

        private void Export()
        {
            if (Session == null)
            {
                return;
            }
            Finish();
            if (Player!.PlayedSound == null)
            {
                return;
            }
            string name = SoundExport.FileName(Player.PlayedSound.Sound.Material, State.Settings);
            string ending = SoundExport.Endings[(int)State.ExportAs];
            string path = EditorUtility.SaveFilePanel("Export " + ending, "", name, ending.Substring(1));
            if (path.Length > 0)
            {
                ShowNotification(new GUIContent(ExportTo(path) ?? "Exported"));
            }
        }

        private void Save()
        {
            if (Session == null)
            {
                return;
            }
            try
            {
                LabelMix mix = State.PlayedMix(Session.Model.Labels);
                HapticMaterial? learnt = State.Material(State.PlayedIndex).Learnt;
                using HapticModel model = HapticModel.Open(Session.Model.File);
                string text = mix.MaterialText(model, SliderCatalog.Of(ModelInUse()).Sliders);
                string label = learnt != null ? learnt.Description.Label : mix.First;
                HapticMaterial? saved = MaterialAssets.SaveAs(text, label, described =>
                {
                    described.FeatureScale = mix.FeatureScale;
                    described.ToneDbPerOctave = mix.ToneDbPerOctave;
                });
                if (saved != null)
                {
                    State.Take(new LabelMix(label, mix.Second, mix.Share, "", null, mix.FeatureScale,
                        mix.ToneDbPerOctave), saved);
                    ShowNotification(new GUIContent("Saved " + saved.name));
                }
            }
            catch (HaptoFlowException error)
            {
                ShowNotification(new GUIContent(error.Message));
            }
        }

        /// <summary>A learnt material or the file of the sliders may have changed.</summary>
        private void OnProjectChanged()
        {
            SliderCatalog.Forget();
            State.MarkChanged();
        }

        private void ShowStroke(Box panel)
        {
            // While a stroke is drawn, the picture follows the pointer; the sound is rendered later.
            strokePicture!.OnGUI(Session!.Stroke, View);
            Box place = PreviewLayout.Patch(panel);
            patch!.Handle(Event.current, place.ToRect(), ClockSeconds());
            if (Player!.PlayedSeconds is { } seconds)
            {
                Playhead.DrawTip(place, Session!.Stroke.At(seconds), View.Palette, State.PlayedIndex);
            }
        }

        private void ShowCharts(Box panel)
        {
            if (Session!.Shown is { } shown)
            {
                chartsPicture!.OnGUI(shown, View);
                if (Player!.PlayedSeconds is { } seconds)
                {
                    Playhead.DrawLines(panel, shown.Panel, shown.Sounds, seconds, View.Palette);
                }
            }
            if (Session.Problem is { } problem)
            {
                ShowHelp(panel, problem, MessageType.Error);
            }
            else if (Session.Remark is { } remark)
            {
                ShowHelp(panel, remark, MessageType.Info);
            }
        }

        private static void ShowHelp(Box panel, string text, MessageType type) =>
            EditorGUI.HelpBox(panel.Inside(16.0).Rows(0.0, 56.0).ToRect(), text, type);

        private void DrawStroke(ICanvas canvas) =>
            StrokePanel.Draw(canvas, View.Palette, View.Layout.StrokePanel, Session!.Stroke);

        private void DrawCharts(ICanvas canvas)
        {
            PreviewResult shown = Session!.Shown!;
            shown.Panel.Draw(canvas, View.Palette, View.Layout.Charts, shown.Request.Active, shown.Qualities,
                shown.Request.Tier);
        }

        protected override void Release()
        {
            Player?.Close();
            Session?.Dispose();
            Session = null;
            strokePicture?.Release();
            chartsPicture?.Release();
        }
    }
}
