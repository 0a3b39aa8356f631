#nullable enable
using System.IO;
using HaptoFlow.Model;
using HaptoFlow.Preview;
using UnityEditor;
using UnityEngine;

namespace HaptoFlow.Editor
{
    /// <summary>Window > HaptoFlow > New Material from Recording: learns a material from a recording of ten seconds,
    /// compares both, and saves the material as an asset. Learning and rendering run in the background.</summary>
    internal sealed class NewMaterialWindow : PreviewWindow<NewMaterialState>
    {
        private static readonly string[] FileFilters = { "Recordings", "csv,wav,w64" };

        private EditorPicture? picture;
        private NewMaterialControls? controls;

        // Null while the sounds are shown. Of the last layout event, as IMGUI needs the same controls in the events that
        // follow it.
        private LearningReport? curves;

        /// <summary>Null while the window is closed.</summary>
        internal NewMaterialSession? Session { get; private set; }

        /// <summary>Null while the window is closed.</summary>
        internal NewMaterialPlayer? Player { get; private set; }

        [MenuItem("Window/HaptoFlow/New Material from Recording", false, 2101)]
        internal static void Open() => Open<NewMaterialWindow>(1200f, 760f);

        protected override PreviewRoom Room => PreviewRoom.WithoutStroke;

        protected override bool IsOpen => Session != null;

        protected override void OnEnable()
        {
            base.OnEnable();
            titleContent = new GUIContent("New Material");
        }

        protected override void Begin()
        {
            Session = new NewMaterialSession(State);
            picture = new EditorPicture(DrawCharts);
            Player = new NewMaterialPlayer(State, Session);
            controls = new NewMaterialControls(State);
            controls.ChoosePressed += () => Later(Choose);
            controls.LearnPressed += Learn;
            controls.SavePressed += () => Later(Save);
            controls.ExportPressed += () => Later(Export);
        }

        protected override void DrawControls() => controls!.Draw(Session!, Player!, ModelInUse());

        protected override void DrawPictures(PreviewLayout layout)
        {
            if (Event.current.type == EventType.Layout)
            {
                curves = State.ShowsCurves && Session!.Report?.HasCurves == true ? Session.Report : null;
            }
            if (curves != null)
            {
                picture!.OnGUI(curves, View);
                CurveTips.Draw(layout.Charts);
            }
            else if (Session!.Shown is { } shown)
            {
                picture!.OnGUI(shown, View);
                if (Player!.PlayedSeconds is { } seconds)
                {
                    Playhead.DrawLines(layout.Charts, shown.Panel, shown.Sounds, seconds, View.Palette);
                }
            }
        }

        internal override void Step()
        {
            if (Session == null)
            {
                return;
            }
            bool isOther = Session.Poll();
            Session.Refresh(ModelInUse());
            if (Player!.Step() || isOther)
            {
                Repaint();
            }
        }

        /// <summary>Blocks until nothing runs any more.</summary>
        internal void Finish()
        {
            Session!.Finish(() => Session.Refresh(ModelInUse()));
            Player!.Step();
            Repaint();
        }

        /// <summary>Chooses a recording's file. Can be undone.</summary>
        internal void Take(string path) => State.Change("Recording", changed =>
        {
            changed.Path = path;
            changed.Name = "";
            changed.Licence = "";
            changed.SpeedMps = 0f;
            changed.ForceNewtons = 0f;
            changed.FullScaleMps2 = 0f;
        });

        internal void Learn()
        {
            HapticModelAsset? model = ModelInUse();
            if (model != null)
            {
                Session?.Learn(model);
            }
        }

        private void Choose()
        {
            string folder = State.Path.Length > 0 ? Path.GetDirectoryName(State.Path) ?? "" : "";
            string path = EditorUtility.OpenFilePanelWithFilters("Choose Recording", folder, FileFilters);
            if (path.Length > 0)
            {
                Take(path);
            }
        }

        private void Save()
        {
            if (Session == null || State.Material.Length == 0)
            {
                return;
            }
            // The label to use where the learnt material is not available.
            HapticMaterial? saved = MaterialAssets.SaveAs(State.Material, Session.Report?.NearestLabel ?? "wood");
            if (saved != null)
            {
                Selection.activeObject = saved;
                ShowNotification(new GUIContent("Saved " + saved.name));
            }
        }

        private void Export()
        {
            if (Session == null || State.Material.Length == 0)
            {
                return;
            }
            string name = MaterialFile.Read(State.Material).Name;
            string path = EditorUtility.SaveFilePanel("Export Material File", "", name, "haptomaterial");
            if (path.Length > 0)
            {
                ShowNotification(new GUIContent(MaterialAssets.Export(path, State.Material) ?? "Exported"));
            }
        }

        private void DrawCharts(ICanvas canvas)
        {
            if (curves != null)
            {
                LearningPanel.Draw(canvas, View.Palette, View.Layout.Charts, curves);
                return;
            }
            ComparisonResult shown = Session!.Shown!;
            shown.Panel.Draw(canvas, View.Palette, View.Layout.Charts, shown.Active);
        }

        protected override void Release()
        {
            Player?.Stop();
            Session?.Dispose();
            Session = null;
            picture?.Release();
        }
    }
}
