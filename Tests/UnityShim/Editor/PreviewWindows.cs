using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEditor;

namespace UnityShim
{
    /// <summary>Simulates the editor around a window, and the user's answers to its dialogs.</summary>
    public static class WindowHost
    {
        /// <summary>The pixels per point of the screen.</summary>
        public static float PixelsPerPoint { get; set; } = 1f;

        /// <summary>Returns the path to save to from the proposed name; null to cancel.</summary>
        public static Func<string, string>? AnswerToSave { get; set; }

        /// <summary>Returns the file to open; null to cancel.</summary>
        public static Func<string>? AnswerToOpen { get; set; }

        /// <summary>The notification that a window showed last.</summary>
        public static string Notification { get; internal set; } = "";

        /// <summary>Runs an update of the editor, of which there are about a hundred a second.</summary>
        public static void Update()
        {
            EditorApplication.RunDelayed();
            EditorApplication.update?.Invoke();
        }

        public static void Close(EditorWindow window)
        {
            Messages messages = Messages.Of(window);
            messages.Send(Message.OnDisable);
            messages.Send(Message.OnDestroy);
            window.Close();
        }

        /// <summary>Simulates a domain reload for a window: serialised fields keep their values, all others are reset.
        /// </summary>
        public static void Reload(EditorWindow window)
        {
            Messages messages = Messages.Of(window);
            EditorSession.ReloadScripts();
            messages.Send(Message.OnDisable);
            messages.Send(Message.OnEnable);
        }

        /// <summary>Draws one pass with the current event.</summary>
        public static IReadOnlyList<Drawn> Draw(EditorWindow window)
        {
            const BindingFlags any = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
            MethodInfo draw = window.GetType().GetMethod("OnGUI", any) ??
                throw new InvalidOperationException(window.GetType().Name + " draws nothing");
            return EditorScreen.Draw((Action)Delegate.CreateDelegate(typeof(Action), window, draw));
        }
    }
}
