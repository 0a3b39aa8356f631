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
    internal sealed class TexturePreviewWindow : EditorWindow
    {
        private const float Width = 1200f;
        private const float Height = 940f;

        // A smaller window scrolls.
        private const float MinimumWidth = 480f;
        private const float MinimumHeight = 320f;

        private static readonly GUIContent FromRecording = new GUIContent("New Material from Recording\u2026",
            "Learns a material from a recording of ten seconds, and saves it as a Haptic Material.");

        [SerializeField]
        private TexturePreviewState? state;

        private EditorPicture? strokePicture;
        private EditorPicture? chartsPicture;
        private PreviewControls? controls;
        private SliderControls? sliders;
        private PreviewPlayer? player;
        private PatchInput? patch;
        private PreviewView? view;
        private Vector2 scroll;

        /// <summary>For scripts and tests that control the window.</summary>
        internal TexturePreviewState State => state!;

        /// <summary>Null while the window is closed.</summary>
        internal PreviewSession? Session { get; private set; }

        /// <summary>Null while the window is closed.</summary>
        internal PreviewPlayer? Player => player;

        /// <summary>Clock for drawn strokes.</summary>
        internal Func<double> ClockSeconds { get; set; } = () => EditorApplication.timeSinceStartup;

        [MenuItem("Window/HaptoFlow/Texture Preview", false, 2100)]
        internal static void Open()
        {
            bool isNew = !HasOpenInstances<TexturePreviewWindow>();
            var window = GetWindow<TexturePreviewWindow>();
            if (isNew)
            {
                Rect place = window.position;
                window.position = new Rect(place.x, place.y, Width, Height);
            }
        }

        /// <summary>Opens the window with the material of a surface or of a Haptic Material asset.</summary>
        internal static void Open(Object described)
        {
            Open();
            if (SceneMaterial.TryRead(described, out LabelMix mix, out HapticMaterial? learnt))
            {
                GetWindow<TexturePreviewWindow>().State.Take(mix, learnt);
            }
        }

        private void OnEnable()
        {
            titleContent = new GUIContent("Texture Preview");
            minSize = new Vector2(MinimumWidth, MinimumHeight);
            if (state == null)
            {
                state = CreateInstance<TexturePreviewState>();
                state.hideFlags = HideFlags.HideAndDontSave;
            }
            Session = new PreviewSession(state);
            strokePicture = new EditorPicture(DrawStroke);
            chartsPicture = new EditorPicture(DrawCharts);
            controls = new PreviewControls(state);
            sliders = new SliderControls(state);
            player = new PreviewPlayer(state, Session);
            patch = new PatchInput(state);
            patch.Ended += player.PlayWhenReady;
            Undo.undoRedoPerformed += OnUndo;
            EditorApplication.update += Step;
            EditorApplication.projectChanged += OnProjectChanged;
            AssemblyReloadEvents.beforeAssemblyReload += Release;
        }

        private void OnDisable()
        {
            Undo.undoRedoPerformed -= OnUndo;
            EditorApplication.update -= Step;
            EditorApplication.projectChanged -= OnProjectChanged;
            AssemblyReloadEvents.beforeAssemblyReload -= Release;
            Release();
        }

        private void OnDestroy()
        {
            if (state != null)
            {
                DestroyImmediate(state);
            }
        }

        private void OnGUI()
        {
            if (Session == null)
            {
                return;
            }
            if (PreviewKeys.Handle(Event.current, State, player!.Toggle, ExportLater))
            {
                // The change may need controls that this event did not lay out.
                Repaint();
                return;
            }
            PreviewRoom room = State.ShowsSliders ? PreviewRoom.WithSliders : PreviewRoom.Default;
            view = PreviewView.Of(position, room, view);
            PreviewLayout layout = view.Layout;
            var all = new Rect(0f, 0f, (float)layout.Width, (float)layout.Height);
            var window = new Rect(0f, 0f, position.width, position.height);
            using var scrolled = new GUI.ScrollViewScope(window, scroll, all);
            scroll = scrolled.scrollPosition;
            using (new GUILayout.AreaScope(layout.Controls.ToRect()))
            {
                controls!.Draw(Session.Model);
                if (SceneControls.Draw(State, Session.Model) is { } message)
                {
                    ShowNotification(new GUIContent(message));
                }
                player.DrawButtons(ExportLater);
                sliders!.Draw(ModelInUse(), SaveLater);
                if (GUILayout.Button(FromRecording))
                {
                    NewMaterialWindow.Open();
                }
            }
            ShowStroke(layout.StrokePanel);
            ShowCharts(layout.Charts);
        }

        /// <summary>Called at each editor update: submits changes, takes results, and continues playback.</summary>
        internal void Step()
        {
            if (Session == null)
            {
                return;
            }
            Session.Refresh(ModelInUse(), GUIUtility.hotControl != 0);
            bool isOther = Session.Poll();
            if (player!.Step() || isOther)
            {
                Repaint();
            }
        }

        /// <summary>Blocks until the present settings are rendered.</summary>
        internal void Finish()
        {
            Session!.Refresh(ModelInUse(), false);
            Session.Finish();
            player!.Step();
            Repaint();
        }

        /// <summary>Writes the active sound to a WAV file.</summary>
        /// <returns>An error message; null on success.</returns>
        internal string? ExportTo(string path)
        {
            Finish();
            return Session!.Problem ?? WaveExport.Write(path, player!.PlayedSound!.Sound);
        }

        // A modal dialog within OnGUI would disturb the layout, so that it opens after the event.
        private void ExportLater() => EditorApplication.delayCall += Export;

        private void Export()
        {
            if (Session == null)
            {
                return;
            }
            Finish();
            if (player!.PlayedSound == null)
            {
                return;
            }
            string name = WaveExport.FileName(player.PlayedSound.Sound.Material, State.Settings);
            string path = EditorUtility.SaveFilePanel("Export WAV", "", name, "wav");
            if (path.Length > 0)
            {
                ShowNotification(new GUIContent(ExportTo(path) ?? "Exported"));
            }
        }

        private void SaveLater() => EditorApplication.delayCall += Save;

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

        private HapticModelAsset? ModelInUse() => State.Model != null ? State.Model : LabelCatalog.ModelInUse();

        private void OnUndo()
        {
            State.MarkChanged();
            Repaint();
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
            strokePicture!.OnGUI(Session!.Stroke, view!);
            Box place = PreviewLayout.Patch(panel);
            patch!.Handle(Event.current, place.ToRect(), ClockSeconds());
            if (player!.PlayedSeconds is { } seconds)
            {
                Playhead.DrawTip(place, Session!.Stroke.At(seconds), view!.Palette, State.PlayedIndex);
            }
        }

        private void ShowCharts(Box panel)
        {
            if (Session!.Shown is { } shown)
            {
                chartsPicture!.OnGUI(shown, view!);
                if (player!.PlayedSeconds is { } seconds)
                {
                    Playhead.DrawLines(panel, shown.Sounds, seconds, view!.Palette);
                }
            }
            if (Session.Problem is { } problem)
            {
                Box help = panel.Inside(16.0).Rows(0.0, 56.0);
                EditorGUI.HelpBox(help.ToRect(), problem, MessageType.Error);
            }
        }

        private void DrawStroke(ICanvas canvas) =>
            StrokePanel.Draw(canvas, view!.Palette, view.Layout.StrokePanel, Session!.Stroke);

        private void DrawCharts(ICanvas canvas)
        {
            PreviewResult shown = Session!.Shown!;
            shown.Panel.Draw(canvas, view!.Palette, view.Layout.Charts, shown.Request.Active, shown.Qualities,
                shown.Request.Tier);
        }

        /// <summary>Frees everything that would outlive a domain reload.</summary>
        private void Release()
        {
            player?.Close();
            Session?.Dispose();
            Session = null;
            strokePicture?.Release();
            chartsPicture?.Release();
        }
    }
}
